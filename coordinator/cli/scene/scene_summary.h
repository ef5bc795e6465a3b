#pragma once

// Summary of a scene or model, for `bandsaw info`.

#include <cstdint>
#include <string>
#include <vector>

#include "renderlib/geometry/box.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

/// A kind of object and its number of occurrences.
struct Count {
  std::string what;  ///< "sphere", "8-bit sRGB image"
  std::uint64_t count = 0;
};

struct SceneSummary {
  PackageInfo info;
  std::string camera;  ///< a sentence without full stop
  std::string filter;  ///< "box of radius 0.5"
  std::vector<Count> shapes;
  /// Triangles of meshes, counted once per placement, and loose triangles.
  std::uint64_t triangles = 0;
  std::vector<Count> materials;
  std::vector<Count> textures;
  std::uint64_t texture_bytes = 0;
  std::uint64_t lights = 0;  ///< emissive primitives, counted once per placement
  std::vector<Count> lights_without_size;
  std::string background;    ///< "gradient", "equirectangular image of 128×64"
  std::vector<Count> media;  ///< kinds of media, and as "boundary" the shapes that bound them
  std::uint64_t geometry_bytes = 0;  ///< shapes, vertices and placements in memory
  /// Conservative: instances are bounded by the transformed boxes of their meshes.
  Box bounds;
  std::uint64_t package_bytes = 0;  ///< manifest and blobs
  std::uint64_t tree_bytes = 0;     ///< size of the BVHs; 0: not built
};

/// Summarises a scene. Kinds that do not occur are omitted.
SceneSummary summary_of(const SceneDescription& scene, const PackageInfo& info,
                        std::uint64_t package_bytes);

/// Formats the summary as text; the last lines list what was left out or repaired.
std::vector<std::string> summary_text(const SceneSummary& summary);
/// Formats the summary as one JSON object.
std::string summary_json(const SceneSummary& summary);

}  // namespace bandsaw::coordinator
