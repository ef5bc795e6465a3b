#pragma once

// Checks that a scene has no more primitives than BVHs can hold, and that no mesh has more
// positions than 32-bit indices can count. Only counts are needed, so the check can run before
// memory is allocated.

#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Maximum number of positions of a mesh. Triangles refer to their corners by 32-bit indices.
inline constexpr std::uint64_t kMaxMeshPositions = std::uint64_t{1} << 32;

/// Numbers of the shapes and instances that are in one BVH. This is the BVH of one group, or the
/// BVH of the scene, which has the shapes and instances outside of groups and meshes.
struct ShapeCounts {
  std::uint64_t spheres = 0;
  std::uint64_t quads = 0;
  std::uint64_t triangles = 0;
  std::uint64_t disks = 0;
  std::uint64_t instances = 0;
};

/// Returns INVALID_ARGUMENT if a mesh has more triangles than a BVH can hold, or more than
/// kMaxMeshPositions positions. `field` is the name of the mesh in the message: "meshes[3]: has
/// 600000000 triangles, a mesh holds at most 536870911: split it into several meshes".
absl::Status check_mesh_counts(absl::string_view field, std::uint64_t triangles,
                               std::uint64_t positions);

/// Returns INVALID_ARGUMENT if one BVH (accel/capacity.h) cannot hold the shapes and instances of
/// the scene or group that `field` names.
absl::Status check_shape_counts(absl::string_view field, const ShapeCounts& counts);

/// Runs check_mesh_counts() and check_shape_counts() for all parts of a geometry. `prefix` is
/// prepended to the names of fields.
absl::Status check_geometry_counts(absl::string_view prefix, const Geometry& geometry);

}  // namespace bandsaw
