// Checks numbers of shapes, instances, triangles and positions against the limits of a BVH.

#include "renderlib/scene/check_counts.h"

#include "absl/strings/str_cat.h"
#include "renderlib/accel/capacity.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/validate_field.h"

namespace bandsaw {
namespace {

ShapeCounts counts_of(const Shapes& shapes) {
  return {.spheres = shapes.spheres.size(),
          .quads = shapes.quads.size(),
          .triangles = shapes.triangles.size(),
          .disks = shapes.disks.size()};
}

}  // namespace

absl::Status check_mesh_counts(absl::string_view field, std::uint64_t triangles,
                               std::uint64_t positions) {
  if (triangles > kMaxTreeItems) {
    return invalid(field, absl::StrCat("has ", triangles, " triangles, a mesh holds at most ",
                                       kMaxTreeItems, ": split it into several meshes"));
  }
  if (positions > kMaxMeshPositions) {
    return invalid(field, absl::StrCat("has ", positions, " positions, a mesh holds at most ",
                                       kMaxMeshPositions, ": split it into several meshes"));
  }
  return absl::OkStatus();
}

absl::Status check_shape_counts(absl::string_view field, const ShapeCounts& counts) {
  // Each count is a number of bytes, which is below 2^64, divided by at least 24. So the sum does
  // not overflow.
  const std::uint64_t items =
      counts.spheres + 2 * counts.quads + counts.triangles + counts.disks + counts.instances;
  if (items > kMaxTreeItems) {
    return invalid(field,
                   absl::StrCat("has ", counts.spheres, " spheres, ", counts.quads, " quads, ",
                                counts.triangles, " triangles, ", counts.disks, " disks and ",
                                counts.instances, " instances, which is ", items,
                                " with quads counted twice; at most ", kMaxTreeItems,
                                " are allowed in one space: put some into groups or a mesh"));
  }
  return absl::OkStatus();
}

absl::Status check_geometry_counts(absl::string_view prefix, const Geometry& geometry) {
  ShapeCounts loose = counts_of(geometry);
  loose.instances = geometry.instances.size();
  RETURN_IF_ERROR(check_shape_counts(absl::StrCat(prefix, "shapes"), loose));
  for (std::size_t i = 0; i < geometry.groups.size(); ++i) {
    RETURN_IF_ERROR(
        check_shape_counts(item(absl::StrCat(prefix, "groups"), i), counts_of(geometry.groups[i])));
  }
  for (std::size_t i = 0; i < geometry.meshes.size(); ++i) {
    const Mesh& mesh = geometry.meshes[i];
    RETURN_IF_ERROR(check_mesh_counts(item(absl::StrCat(prefix, "meshes"), i),
                                      mesh.triangles.size(), mesh.positions.size()));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
