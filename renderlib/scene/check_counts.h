#pragma once

// Whether trees and the numbers of primitives can hold what a scene has. Counts alone are judged,
// so that this can be done before memory is taken for what is counted.

#include <cstdint>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// A triangle names its corners by numbers of 32 bits.
inline constexpr std::uint64_t kMaxMeshPositions = std::uint64_t{1} << 32;

/// The shapes that lie loose in one space, and the instances that are placed there.
struct ShapeCounts {
  std::uint64_t spheres = 0;
  std::uint64_t quads = 0;
  std::uint64_t triangles = 0;
  std::uint64_t disks = 0;
  std::uint64_t instances = 0;
};

/// INVALID_ARGUMENT: "meshes[3]: has 600000000 triangles, a mesh holds at most 536870911: split it
/// into several meshes". `field` names the mesh.
absl::Status check_mesh_counts(absl::string_view field, std::uint64_t triangles,
                               std::uint64_t positions);

/// INVALID_ARGUMENT where one tree (accel/capacity.h) cannot hold the shapes and instances of the
/// scene or group that `field` names.
absl::Status check_shape_counts(absl::string_view field, const ShapeCounts& counts);

/// Both of the above for all of a geometry. Names of fields begin with `prefix`.
absl::Status check_geometry_counts(absl::string_view prefix, const Geometry& geometry);

}  // namespace bandsaw
