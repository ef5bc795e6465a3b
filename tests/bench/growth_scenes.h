#pragma once

// Scenes that grow in one thing each.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "renderlib/render/settings.h"
#include "renderlib/scene/description.h"

namespace bandsaw::bench {

struct GrownScene {
  SceneDescription scene;
  RenderSettings settings;
  std::uint64_t samples = 16;
};

/// One thing to have more and more of; of everything else the scene keeps as much.
struct Family {
  std::string name;  ///< "triangles"
  std::vector<double> sizes;
  std::function<GrownScene(double size)> scene;
};

/// `quick`: without the largest sizes.
std::vector<Family> families(bool quick);

}  // namespace bandsaw::bench
