// Reads PLY meshes, and treats meshes as Mitsuba does: computes vertex normals that are weighted by
// angles, and turns each triangle to the side of its vertices' normals.

#include "renderlib/import/mitsuba/source_mesh.h"

#include <utility>

#include "renderlib/base/status_macros.h"
#include "renderlib/import/convert/read_ply.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/float3.h"
#include "renderlib/math/vec.h"

namespace bandsaw::mitsuba {
namespace {

/// Returns (b - a) x (c - a) for a triangle with the corners a, b and c. The length of the
/// result is twice the area of the triangle.
Vec3 across(const PlyMesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const Vec3 a = vec3(mesh.positions[triangle[0]]);
  return cross(vec3(mesh.positions[triangle[1]]) - a, vec3(mesh.positions[triangle[2]]) - a);
}

/// Returns the angle between two vectors in radians; 0 if one has no length.
double angle_between(const Vec3& a, const Vec3& b) {
  const double lengths = length(a) * length(b);
  return lengths > 0 ? acos(dot(a, b) / lengths) : 0;
}

}  // namespace

absl::StatusOr<SourceMesh> read_ply(absl::string_view bytes, bool flip_v) {
  ASSIGN_OR_RETURN(PlyFile file, bandsaw::read_ply(bytes));
  if (flip_v) {
    for (std::array<float, 2>& uv : file.mesh.uvs) {
      uv[1] = 1 - uv[1];
    }
  }
  return SourceMesh{std::move(file.mesh), std::move(file.attributes)};
}

void add_smooth_normals(PlyMesh& mesh) {
  std::vector<Vec3> sums(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const Vec3 normal = across(mesh, triangle);
    if (!(length(normal) > 0)) {
      continue;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3 corner = vec3(mesh.positions[triangle[i]]);
      const Vec3 next = vec3(mesh.positions[triangle[(i + 1) % 3]]) - corner;
      const Vec3 last = vec3(mesh.positions[triangle[(i + 2) % 3]]) - corner;
      sums[triangle[i]] = sums[triangle[i]] + normalize(normal) * angle_between(next, last);
    }
  }
  mesh.normals.clear();
  for (const Vec3& sum : sums) {
    mesh.normals.push_back(length(sum) > 0 ? float3(normalize(sum))
                                           : std::array<float, 3>{1, 0, 0});
  }
}

void orient_by_normals(PlyMesh& mesh) {
  if (mesh.normals.empty()) {
    return;
  }
  for (auto& triangle : mesh.triangles) {
    const Vec3 sum = vec3(mesh.normals[triangle[0]]) + vec3(mesh.normals[triangle[1]]) +
                     vec3(mesh.normals[triangle[2]]);
    if (dot(across(mesh, triangle), sum) < 0) {
      std::swap(triangle[1], triangle[2]);
    }
  }
}

void turn_over(PlyMesh& mesh) {
  for (auto& triangle : mesh.triangles) {
    std::swap(triangle[1], triangle[2]);
  }
  for (auto& normal : mesh.normals) {
    normal = float3(-vec3(normal));
  }
}

bool has_left_handed_uvs(const PlyMesh& mesh) {
  if (mesh.uvs.empty()) {
    return false;
  }
  // Above 0 if a larger part of the surface has right-handed uvs than left-handed uvs. `area` is
  // twice the signed area of a triangle in uv space.
  double balance = 0;
  for (const auto& triangle : mesh.triangles) {
    const auto& a = mesh.uvs[triangle[0]];
    const auto& b = mesh.uvs[triangle[1]];
    const auto& c = mesh.uvs[triangle[2]];
    const double area = (double{b[0]} - a[0]) * (double{c[1]} - a[1]) -
                        (double{b[1]} - a[1]) * (double{c[0]} - a[0]);
    balance += (area > 0 ? 1 : area < 0 ? -1 : 0) * length(across(mesh, triangle));
  }
  return balance < 0;
}

}  // namespace bandsaw::mitsuba
