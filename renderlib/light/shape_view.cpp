#include <array>
#include <cmath>

#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/shape_light.h"

namespace bandsaw {
namespace {

using Kind = ShapeView::Kind;

/// Relative tolerance, in squared length and in orthogonality, within which axes count as those of
/// a sphere.
constexpr double kRound = 0x1p-46;

Vec3 vertex(const Mesh& mesh, std::uint32_t index) {
  const std::array<float, 3>& p = mesh.positions[index];
  return {p[0], p[1], p[2]};
}

ShapeView triangle_view(const Vec3& a, const Vec3& b, const Vec3& c, bool mirrored) {
  return {.kind = Kind::kTriangle, .a = a, .u = b - a, .v = c - a, .mirrored = mirrored};
}

ShapeView mesh_view(const Mesh& mesh, std::uint32_t primitive, const Transform& to_world) {
  const std::array<std::uint32_t, 3>& t = mesh.triangles[primitive];
  return triangle_view(to_world.point(vertex(mesh, t[0])), to_world.point(vertex(mesh, t[1])),
                       to_world.point(vertex(mesh, t[2])), determinant(to_world) < 0);
}

/// Returns the shape in the space of `shapes`.
ShapeView view_of(const Shapes& shapes, std::size_t primitive) {
  const auto [kind, index] = shape_ref(shapes, primitive);
  if (kind == ShapeKind::kSphere) {
    const Sphere& sphere = shapes.spheres[index];
    return {.kind = Kind::kSphere, .a = sphere.center, .radius = sphere.radius};
  }
  if (kind == ShapeKind::kQuad) {
    const Quad& quad = shapes.quads[index];
    return {.kind = Kind::kQuad, .a = quad.corner, .u = quad.u, .v = quad.v};
  }
  if (kind == ShapeKind::kDisk) {
    const Disk& disk = shapes.disks[index];
    const DiskAxes axes = axes_of(disk);
    return {.kind = Kind::kDisk,
            .a = disk.center,
            .u = axes.u * disk.radius,
            .v = axes.v * disk.radius};
  }
  const Triangle& triangle = shapes.triangles[index];
  return triangle_view(triangle.a, triangle.b, triangle.c, false);
}

/// Returns true if the axes are those of a sphere.
bool is_round(const ShapeView& shape) {
  const double square = length_squared(shape.u);
  const double slack = kRound * square;
  return std::abs(length_squared(shape.v) - square) <= slack &&
         std::abs(length_squared(shape.w) - square) <= slack &&
         std::abs(dot(shape.u, shape.v)) <= slack && std::abs(dot(shape.v, shape.w)) <= slack &&
         std::abs(dot(shape.w, shape.u)) <= slack;
}

ShapeView placed(const ShapeView& shape, const Transform& to_world) {
  ShapeView result = shape;
  result.a = to_world.point(shape.a);
  if (shape.kind != Kind::kSphere) {
    result.u = to_world.direction(shape.u);
    result.v = to_world.direction(shape.v);
    result.mirrored = determinant(to_world) < 0;
    return result;
  }
  result.kind = Kind::kEllipsoid;
  result.u = to_world.direction({shape.radius, 0, 0});
  result.v = to_world.direction({0, shape.radius, 0});
  result.w = to_world.direction({0, 0, shape.radius});
  if (is_round(result)) {
    result.kind = Kind::kSphere;
    result.radius = length(result.u);
  }
  return result;
}

/// Returns the bounding sphere of a primitive in the space of its instance, before placement.
Ball local_ball(const Geometry& geometry, const Instance& instance, std::uint32_t primitive) {
  const Shapes* group = group_of(geometry, instance);
  return bounds(group != nullptr
                    ? view_of(*group, primitive)
                    : mesh_view(geometry.meshes[index_of(instance.mesh)], primitive, {}));
}

}  // namespace

Ball moving_ball(const Geometry& geometry, PrimitiveId id, const Interval& interval) {
  const Instance& instance = geometry.instances[id.instance - 1];
  const Ball ball = local_ball(geometry, instance, id.primitive);
  const Vec3 half = {ball.radius, ball.radius, ball.radius};
  const auto moving =
      moving_bounds(geometry, instance, {ball.center - half, ball.center + half}, interval);
  if (!moving) {
    return ball;  // The bounds cannot be computed, so the primitive cannot be hit.
  }
  Box box = moving->at_open;
  box.add(moving->at_close.lo);
  box.add(moving->at_close.hi);
  return {0.5 * (box.lo + box.hi), length(box.hi - box.lo) / 2};
}

ShapeView shape_view(const Geometry& geometry, PrimitiveId id, double time) {
  if (id.instance == 0) {
    return view_of(geometry, id.primitive);
  }
  const Instance& instance = geometry.instances[id.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, time);
  const Shapes* group = group_of(geometry, instance);
  return group != nullptr
             ? placed(view_of(*group, id.primitive), to_world)
             : mesh_view(geometry.meshes[index_of(instance.mesh)], id.primitive, to_world);
}

MaterialId material_of(const Geometry& geometry, PrimitiveId id) {
  return id.instance == 0
             ? material_of(static_cast<const Shapes&>(geometry), id.primitive)
             : material_of(geometry, geometry.instances[id.instance - 1], id.primitive);
}

}  // namespace bandsaw
