#pragma once

// Makes and formats the summary of a scene or model that `bandsaw info` prints.

#include <cstdint>
#include <string>
#include <vector>

#include "renderlib/geometry/box.h"
#include "renderlib/package/package.h"

namespace bandsaw::coordinator {

/// A kind of object and its number of occurrences.
struct Count {
  std::string what;  ///< such as "sphere" or "8-bit image of 64×64"
  std::uint64_t count = 0;
};

struct SceneSummary {
  PackageInfo info;
  std::string camera;  ///< a description without full stop
  std::string filter;  ///< the pixel filter, such as "box of radius 0.5"
  std::vector<Count> shapes;
  /// Triangles of meshes, counted once for each placement of the mesh, and single triangles.
  std::uint64_t triangles = 0;
  std::vector<Count> materials;
  std::vector<Count> textures;
  std::uint64_t texture_bytes = 0;
  std::uint64_t lights = 0;                ///< emissive primitives, counted once for each placement
  std::vector<Count> lights_without_size;  ///< such as "point" and "directional"
  std::string background;  ///< such as "gradient" or "equirectangular image of 128×64"
  /// Kinds of media. The entry "boundary" counts the shapes that bound media.
  std::vector<Count> media;
  std::uint64_t geometry_bytes = 0;  ///< size of shapes, vertices and placements in memory
  /// Bounding box of all geometry in world space. It may be larger than the geometry, because the
  /// transformed boxes of meshes are used for their instances.
  Box bounds;
  std::uint64_t package_bytes = 0;  ///< manifest and blobs
  std::uint64_t tree_bytes = 0;     ///< size of the BVHs; 0: not built
};

/// Summarises a scene. The lists omit kinds that do not occur. `package_bytes`: the size of the
/// manifest and the blobs, for SceneSummary::package_bytes. SceneSummary::tree_bytes stays 0.
SceneSummary summary_of(const SceneDescription& scene, const PackageInfo& info,
                        std::uint64_t package_bytes);

/// Formats the summary as lines of text; the last ones list what the importer left out or repaired.
std::vector<std::string> summary_text(const SceneSummary& summary);
/// Formats the summary as one JSON object.
std::string summary_json(const SceneSummary& summary);

}  // namespace bandsaw::coordinator
