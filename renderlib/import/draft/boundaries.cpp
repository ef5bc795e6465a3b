// Makes the boundary of a medium from a closed mesh. If the triangles of the mesh face inwards,
// they are reversed. Each mesh is converted once.

#include "renderlib/import/draft/boundaries.h"

#include <utility>

#include "renderlib/geometry/closed.h"

namespace bandsaw {
namespace {

/// Returns six times the volume that the mesh encloses; negative if its normals point inwards.
double signed_volume(const Mesh& mesh) {
  const auto corner = [&](std::uint32_t index) {
    const std::array<float, 3>& p = mesh.positions[index];
    return Vec3{p[0], p[1], p[2]};
  };
  // Points are taken relative to a corner of the mesh, so that a distant origin costs no precision.
  const Vec3 from = corner(mesh.triangles[0][0]);
  double sum = 0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += dot(corner(a) - from, cross(corner(b) - from, corner(c) - from));
  }
  return sum;
}

}  // namespace

std::optional<Instance> mesh_boundary(const Instance& placed, MediumId inside, SceneDraft& draft) {
  Geometry& boundaries = draft.out.scene.media.boundaries;
  auto known = draft.boundary_meshes.find(placed.mesh);
  if (known == draft.boundary_meshes.end()) {
    const Mesh& mesh = draft.out.scene.geometry.meshes[index_of(placed.mesh)];
    if (open_edges(mesh) > 0) {
      return std::nullopt;
    }
    Mesh boundary{mesh.positions, mesh.triangles, {}, {}};
    boundary.positions_at_close = mesh.positions_at_close;
    if (signed_volume(boundary) < 0) {
      for (auto& [a, b, c] : boundary.triangles) {
        std::swap(b, c);
      }
    }
    const MeshId id{static_cast<std::uint32_t>(boundaries.meshes.size())};
    known = draft.boundary_meshes.emplace(placed.mesh, id).first;
    boundaries.meshes.push_back(std::move(boundary));
  }
  return Instance{known->second, filled_with(inside), placed.to_world, kNoGroup, placed.frame};
}

}  // namespace bandsaw
