#include <algorithm>
#include <cmath>

#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/geometry/shape_surface.h"
#include "renderlib/geometry/surface.h"

namespace bandsaw {
namespace {

Vec3 vec(const std::array<float, 3>& p) { return {p[0], p[1], p[2]}; }

/// dp/du and dp/dv of the affine map that takes the triangle's uvs to its corners.
void along_mesh(const Geometry& geometry, const Transform& to_world, bool second,
                SurfacePoint& point) {
  const Instance& instance = geometry.instances[point.id.instance - 1];
  const Mesh& mesh = geometry.meshes[index_of(instance.mesh)];
  const auto& corner = mesh.triangles[point.id.primitive];
  const Vec3 a = vec(mesh.positions[corner[0]]);
  const Vec3 e1 = to_world.direction(vec(mesh.positions[corner[1]]) - a);
  const Vec3 e2 = to_world.direction(vec(mesh.positions[corner[2]]) - a);
  const auto& uvs = second && !mesh.uvs2.empty() ? mesh.uvs2 : mesh.uvs;
  if (uvs.empty()) {
    point.along_u = e1;
    point.along_v = e2;
    return;
  }
  const auto uv = [&](std::size_t i, std::size_t axis) {
    return double{uvs[corner[i]][axis]} - double{uvs[corner[0]][axis]};
  };
  const double du1 = uv(1, 0);
  const double dv1 = uv(1, 1);
  const double du2 = uv(2, 0);
  const double dv2 = uv(2, 1);
  const double area = du1 * dv2 - du2 * dv1;
  const double size = std::max({std::abs(du1), std::abs(dv1), std::abs(du2), std::abs(dv2)});
  if (!(std::abs(area) > 1e-12 * size * size)) {
    return;
  }
  const Vec3 u = (e1 * dv2 - e2 * dv1) / area;
  const Vec3 v = (e2 * du1 - e1 * du2) / area;
  if (is_finite(u) && is_finite(v)) {
    point.along_u = u;
    point.along_v = v;
  }
}

/// In the space the shapes lie in; `normal` is a sphere's there.
void along_shape(const Shapes& shapes, const Vec3& normal, SurfacePoint& point) {
  const auto [kind, index] = shape_ref(shapes, point.id.primitive);
  switch (kind) {
    case ShapeKind::kSphere:
      point.along_u = cross({0, 1, 0}, normal);
      point.along_v = cross(normal, point.along_u);
      return;
    case ShapeKind::kQuad:
      point.along_u = shapes.quads[index].u;
      point.along_v = shapes.quads[index].v;
      return;
    case ShapeKind::kTriangle: {
      const Triangle& triangle = shapes.triangles[index];
      point.along_u = triangle.b - triangle.a;
      point.along_v = triangle.c - triangle.a;
      return;
    }
    case ShapeKind::kDisk: {
      const DiskAxes axes = axes_of(shapes.disks[index]);
      point.along_u = axes.u;
      point.along_v = axes.v;
      return;
    }
  }
}

}  // namespace

void add_uv_directions(const Geometry& geometry, bool second, SurfacePoint& point) {
  if (point.id.instance == 0) {
    along_shape(geometry, point.geometric_normal, point);
    return;
  }
  const Instance& instance = geometry.instances[point.id.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, point.time);
  if (instance.group == kNoGroup) {
    along_mesh(geometry, to_world, second, point);
    return;
  }
  // A sphere's point from its centre is along the normal in its own space.
  along_shape(*group_of(geometry, instance), unit_or(point.object_position, {0, 0, 1}), point);
  point.along_u = to_world.direction(point.along_u);
  point.along_v = to_world.direction(point.along_v);
}

}  // namespace bandsaw
