#include "renderlib/scene/clean.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {
namespace {

bool has_area(const Vec3& u, const Vec3& v) {
  // Scaled, so that the area of tiny shapes does not underflow.
  const double size = std::max(max_abs(u), max_abs(v));
  if (!(size > 0) || !std::isfinite(size)) {
    return false;
  }
  const Vec3 normal = cross(u / size, v / size);
  return is_finite(normal) && max_abs(normal) > 0;
}

template <std::size_t N>
bool all_finite(const std::array<float, N>& values) {
  return std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); });
}

template <std::size_t N>
void zero_if_not_finite(std::vector<std::array<float, N>>& list) {
  for (std::array<float, N>& values : list) {
    if (!all_finite(values)) {
      values.fill(0);
    }
  }
}

std::size_t clean_mesh(Mesh& mesh) {
  zero_if_not_finite(mesh.normals);
  zero_if_not_finite(mesh.uvs);
  zero_if_not_finite(mesh.uvs2);
  zero_if_not_finite(mesh.colors);
  return std::erase_if(mesh.triangles, [&](const std::array<std::uint32_t, 3>& triangle) {
    std::array<Vec3, 3> corners;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::array<float, 3>& p = mesh.positions[triangle[i]];
      corners[i] = {p[0], p[1], p[2]};
    }
    return !has_area(corners[1] - corners[0], corners[2] - corners[0]);
  });
}

std::size_t clean_shapes(Shapes& shapes) {
  return std::erase_if(shapes.quads, [](const Quad& q) { return !has_area(q.u, q.v); }) +
         std::erase_if(shapes.triangles,
                       [](const Triangle& t) { return !has_area(t.b - t.a, t.c - t.a); });
}

}  // namespace

std::size_t clean(Geometry& geometry) {
  std::size_t dropped = clean_shapes(geometry);
  std::vector<std::size_t> dropped_of_group;
  for (Shapes& group : geometry.groups) {
    dropped_of_group.push_back(clean_shapes(group));
  }
  std::vector<std::size_t> dropped_of_mesh;
  for (Mesh& mesh : geometry.meshes) {
    dropped_of_mesh.push_back(clean_mesh(mesh));
  }
  for (const Instance& instance : geometry.instances) {
    dropped += instance.group == kNoGroup ? dropped_of_mesh[index_of(instance.mesh)]
                                          : dropped_of_group[index_of(instance.group)];
  }
  return dropped;
}

}  // namespace bandsaw
