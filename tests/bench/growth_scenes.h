#pragma once

// Scenes that grow in one respect each.

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

/// A quantity that grows while everything else stays the same.
struct Family {
  std::string name;  ///< "triangles"
  std::vector<double> sizes;
  std::function<GrownScene(double size)> scene;
};

/// If `quick`, the largest sizes are omitted.
std::vector<Family> families(bool quick);

}  // namespace bandsaw::bench
