// Repairs a model's mesh. Normals that are zero or not finite are computed from the triangles, and
// uvs that are not finite become 0. If any vertex of the mesh is not finite, all vertices that no
// triangle uses are removed.

#include "renderlib/import/model/repair_mesh.h"
#include "renderlib/math/float3.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace bandsaw {
namespace {

bool is_good_normal(const std::array<float, 3>& n) {
  const double squared = length_squared(vec3(n));
  return std::isfinite(squared) && squared > 0;
}

/// Keeps only the values at the indices `kept`, which are in ascending order.
template <class T>
void keep(std::vector<T>& values, const std::vector<std::uint32_t>& kept) {
  if (values.empty()) {
    return;
  }
  for (std::size_t i = 0; i < kept.size(); ++i) {
    values[i] = values[kept[i]];
  }
  values.resize(kept.size());
}

/// Replaces each normal that is zero or not finite by the area-weighted mean of the normals of its
/// triangles. `normals` belong to the vertices `positions`. Returns the number of replaced
/// normals.
std::size_t repair(const std::vector<std::array<std::uint32_t, 3>>& triangles,
                   const std::vector<std::array<float, 3>>& positions,
                   std::vector<std::array<float, 3>>& normals) {
  std::map<std::uint32_t, Vec3> repaired;
  for (std::uint32_t i = 0; i < normals.size(); ++i) {
    if (!is_good_normal(normals[i])) {
      repaired[i] = {};
    }
  }
  if (repaired.empty()) {
    return 0;
  }
  for (const auto& [a, b, c] : triangles) {
    const Vec3 p = vec3(positions[a]);
    const Vec3 normal = cross(vec3(positions[b]) - p, vec3(positions[c]) - p);
    for (const std::uint32_t corner : {a, b, c}) {
      if (const auto found = repaired.find(corner); found != repaired.end()) {
        found->second = found->second + normal;
      }
    }
  }
  for (const auto& [vertex, sum] : repaired) {
    const Vec3 unit = length_squared(sum) > 0 ? normalize(sum) : Vec3{0, 1, 0};
    normals[vertex] = float3(unit);
  }
  return repaired.size();
}

}  // namespace

void drop_unused_vertices(Mesh& mesh) {
  const auto finite = [](const std::array<float, 3>& p) { return is_finite(vec3(p)); };
  const auto all_finite = [&](const std::vector<std::array<float, 3>>& positions) {
    return std::all_of(positions.begin(), positions.end(), finite);
  };
  if (all_finite(mesh.positions) && all_finite(mesh.positions_at_close)) {
    return;
  }
  std::vector<bool> used(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t corner : triangle) {
      used[corner] = true;
    }
  }
  std::vector<std::uint32_t> kept;
  std::vector<std::uint32_t> new_index(used.size());
  for (std::uint32_t i = 0; i < used.size(); ++i) {
    if (used[i]) {
      new_index[i] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(i);
    }
  }
  keep(mesh.positions, kept);
  keep(mesh.normals, kept);
  keep(mesh.uvs, kept);
  keep(mesh.uvs2, kept);
  keep(mesh.colors, kept);
  keep(mesh.positions_at_close, kept);
  keep(mesh.normals_at_close, kept);
  for (auto& triangle : mesh.triangles) {
    for (std::uint32_t& corner : triangle) {
      corner = new_index[corner];
    }
  }
}

std::size_t repair_normals(Mesh& mesh) {
  return repair(mesh.triangles, mesh.positions, mesh.normals) +
         repair(mesh.triangles, mesh.positions_at_close, mesh.normals_at_close);
}

std::size_t repair_uvs(Mesh& mesh) {
  std::size_t repaired = 0;
  for (auto* uvs : {&mesh.uvs, &mesh.uvs2}) {
    for (auto& uv : *uvs) {
      if (!std::isfinite(uv[0]) || !std::isfinite(uv[1])) {
        uv = {0, 0};
        ++repaired;
      }
    }
  }
  return repaired;
}

}  // namespace bandsaw
