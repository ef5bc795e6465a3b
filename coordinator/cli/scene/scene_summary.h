#pragma once

// What is in a scene or model, for `bandsaw info`.

#include <cstdint>
#include <string>
#include <vector>

#include "renderlib/geometry/box.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

/// Something and how often it occurs.
struct Count {
  std::string what;  ///< "sphere", "8-bit sRGB image"
  std::uint64_t count = 0;
};

struct SceneSummary {
  PackageInfo info;
  std::string camera;  ///< a sentence without its full stop
  std::string filter;  ///< "box of radius 0.5"
  std::vector<Count> shapes;
  std::uint64_t triangles = 0;  ///< of all meshes as often as they are placed, and loose ones
  std::vector<Count> materials;
  std::vector<Count> textures;
  std::uint64_t texture_bytes = 0;
  std::uint64_t lights = 0;  ///< spheres, quads and triangles that emit
  std::vector<Count> lights_without_size;
  std::string background;            ///< "gradient", "equirectangular image of 128×64"
  std::vector<Count> media;          ///< and, as "boundary", the shapes that they fill
  std::uint64_t geometry_bytes = 0;  ///< of shapes, vertices and placements, in memory
  Box bounds;  ///< of instances: of their meshes' boxes, so they may be smaller
  std::uint64_t package_bytes = 0;  ///< of manifest and blobs
  std::uint64_t tree_bytes = 0;     ///< of what finds hits; 0: not built
};

/// Counts of kinds that do not occur are left out.
SceneSummary summary_of(const SceneDescription& scene, const PackageInfo& info,
                        std::uint64_t package_bytes);

/// Lines for people; the last ones say what was left out or mended.
std::vector<std::string> summary_text(const SceneSummary& summary);
/// One JSON object.
std::string summary_json(const SceneSummary& summary);

}  // namespace bandsaw::coordinator
