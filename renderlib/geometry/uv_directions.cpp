// Implements add_uv_directions() and add_uv_derivatives() of surface.h, which compute the
// directions in which u and v increase. For the triangles of meshes, the directions follow from the
// map between uvs and corners. For other shapes, the directions have a closed form.

#include <algorithm>
#include <cmath>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/geometry/shape_surface.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

struct Directions {
  Vec3 u;
  Vec3 v;
};

/// Returns the derivatives dp/du and dp/dv, in world space, of the affine map from the triangle's
/// uvs to its corners. They are zero if the uvs have no area.
Directions along_mesh(const Geometry& geometry, const Transform& to_world, bool second,
                      const SurfacePoint& point) {
  const Instance& instance = geometry.instances[point.id.instance - 1];
  const Mesh& mesh = geometry.meshes[index_of(instance.mesh)];
  const auto& corner = mesh.triangles[point.id.primitive];
  const auto at = corners_at(mesh, point.id.primitive, geometry.shutter, point.time);
  const Vec3 e1 = to_world.direction(vec3(at[1]) - vec3(at[0]));
  const Vec3 e2 = to_world.direction(vec3(at[2]) - vec3(at[0]));
  const auto& uvs = second && !mesh.uvs2.empty() ? mesh.uvs2 : mesh.uvs;
  if (uvs.empty()) {
    return {e1, e2};
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
  // A smaller area of the uvs may be rounding error.
  if (!(std::abs(area) > 1e-12 * size * size)) {
    return {};
  }
  const Vec3 u = (e1 * dv2 - e2 * dv1) / area;
  const Vec3 v = (e2 * du1 - e1 * du2) / area;
  return is_finite(u) && is_finite(v) ? Directions{u, v} : Directions{};
}

/// Returns the directions, of any length, in the space of the shapes. `normal` is the normal at the
/// point in this space; it is used only if the shape is a sphere.
Directions along_shape(const Shapes& shapes, const Vec3& normal, const SurfacePoint& point) {
  const auto [kind, index] = shape_ref(shapes, point.id.primitive);
  switch (kind) {
    case ShapeKind::kSphere: {
      const Vec3 u = cross({0, 1, 0}, normal);
      return {u, cross(normal, u)};
    }
    case ShapeKind::kQuad:
      return {shapes.quads[index].u, shapes.quads[index].v};
    case ShapeKind::kTriangle: {
      const Triangle& triangle = shapes.triangles[index];
      return {triangle.b - triangle.a, triangle.c - triangle.a};
    }
    case ShapeKind::kDisk: {
      const DiskAxes axes = axes_of(shapes.disks[index]);
      return {axes.u, axes.v};
    }
  }
  return {};
}

/// Returns the factors on the directions of along_shape() that make them derivatives. On a sphere,
/// u = 1 is a full turn and v = 1 half a turn; both directions have the sine of the angle from the
/// pole as their length.
Vec2 lengths_of(const Shapes& shapes, const SurfacePoint& point, const Directions& along) {
  const auto [kind, index] = shape_ref(shapes, point.id.primitive);
  switch (kind) {
    case ShapeKind::kSphere: {
      const double radius = shapes.spheres[index].radius;
      const double around = length(along.v);
      return {2 * kPi * radius, around > 0 ? kPi * radius / around : 0};
    }
    case ShapeKind::kDisk:
      return {2 * shapes.disks[index].radius, 2 * shapes.disks[index].radius};
    case ShapeKind::kQuad:
    case ShapeKind::kTriangle:
      break;
  }
  return {1, 1};
}

/// Returns the directions at the point in world space, of any length.
Directions uv_directions(const Geometry& geometry, bool second, const SurfacePoint& point) {
  if (point.id.instance == 0) {
    return along_shape(geometry, point.geometric_normal, point);
  }
  const Instance& instance = geometry.instances[point.id.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, point.time);
  if (instance.group == kNoGroup) {
    return along_mesh(geometry, to_world, second, point);
  }
  // In the group's space, the vector from a sphere's centre to the point has the normal's
  // direction.
  const Directions along =
      along_shape(*group_of(geometry, instance), unit_or(point.object_position, {0, 0, 1}), point);
  return {to_world.direction(along.u), to_world.direction(along.v)};
}

}  // namespace

void add_uv_directions(const Geometry& geometry, bool second, SurfacePoint& point) {
  const Directions along = uv_directions(geometry, second, point);
  (second ? point.along_u2 : point.along_u) = along.u;
  (second ? point.along_v2 : point.along_v) = along.v;
}

void add_uv_derivatives(const Geometry& geometry, bool second, SurfacePoint& point) {
  add_uv_directions(geometry, second, point);
  const std::uint32_t placed = point.id.instance;
  if (placed != 0 && geometry.instances[placed - 1].group == kNoGroup) {
    return;  // the directions on a mesh already have the lengths of the derivatives
  }
  const Shapes& shapes =
      placed == 0 ? geometry : *group_of(geometry, geometry.instances[placed - 1]);
  const Vec3 normal =
      placed == 0 ? point.geometric_normal : unit_or(point.object_position, {0, 0, 1});
  const Vec2 lengths = lengths_of(shapes, point, along_shape(shapes, normal, point));
  Vec3& u = second ? point.along_u2 : point.along_u;
  Vec3& v = second ? point.along_v2 : point.along_v;
  u = u * lengths.x;
  v = v * lengths.y;
}

}  // namespace bandsaw
