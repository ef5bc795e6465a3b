#pragma once

// Scenes for growth_bench, which measures how time and memory grow with the size of a scene. In
// each family of scenes one quantity grows, such as the number of triangles.

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
  std::uint64_t samples = 16;  ///< per pixel
};

/// A quantity that grows while everything else stays the same.
struct Family {
  std::string name;                              ///< "triangles"
  std::vector<double> sizes;                     ///< values of the quantity, ascending
  std::function<GrownScene(double size)> scene;  ///< makes the scene of a size
};

/// Returns all families. If `quick`, the largest sizes are omitted.
std::vector<Family> families(bool quick);

}  // namespace bandsaw::bench
