// Implements three functions of shape_light.h. shape_view() transforms a primitive to world space
// as it is at a given time; a sphere whose axes are no longer equal becomes an ellipsoid.
// moving_ball() bounds a primitive while it moves. material_of() returns its material.

#include <array>
#include <cmath>

#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/placement.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

using Kind = ShapeView::Kind;

/// Three axes count as those of a sphere if their squared lengths differ by at most this share, and
/// if their dot products are at most this share of a squared length.
constexpr double kRound = 0x1p-46;

ShapeView triangle_view(const Vec3& a, const Vec3& b, const Vec3& c, bool mirrored) {
  return {.kind = Kind::kTriangle, .a = a, .u = b - a, .v = c - a, .mirrored = mirrored};
}

/// Returns triangle `primitive` of the instance's mesh at `time`, transformed by `to_world`.
ShapeView mesh_view(const Geometry& geometry, const Instance& instance, std::uint32_t primitive,
                    const Transform& to_world, double time) {
  const auto at =
      corners_at(geometry.meshes[index_of(instance.mesh)], primitive, geometry.shutter, time);
  return triangle_view(to_world.point(vec3(at[0])), to_world.point(vec3(at[1])),
                       to_world.point(vec3(at[2])), determinant(to_world) < 0);
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

/// Returns the shape transformed by `to_world`.
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

/// Returns bounds of a primitive in the space of its instance, before placement, at all times.
Box local_box(const Geometry& geometry, const Instance& instance, std::uint32_t primitive) {
  const Interval& shutter = geometry.shutter;
  if (deforms(geometry, instance)) {
    Box box;
    for (const double time : {shutter.open, shutter.close}) {
      for (const auto& p :
           corners_at(geometry.meshes[index_of(instance.mesh)], primitive, shutter, time)) {
        box.add(vec3(p));
      }
    }
    return box;
  }
  const Shapes* group = group_of(geometry, instance);
  const Ball ball =
      bounds(group != nullptr ? view_of(*group, primitive)
                              : mesh_view(geometry, instance, primitive, {}, shutter.open));
  const Vec3 half = {ball.radius, ball.radius, ball.radius};
  return {ball.center - half, ball.center + half};
}

/// Returns bounds of a box that moves with its instance; std::nullopt if its placement is singular.
std::optional<Box> swept(const Geometry& geometry, const Instance& instance, const Box& box) {
  if (instance.frame == kNoFrame) {
    const std::optional<Transform> to_object = inverse(instance.to_world);
    return to_object ? std::optional(placed_bounds(box, instance.to_world, *to_object))
                     : std::nullopt;
  }
  const std::optional<MovingBox> moving = moving_bounds(geometry, instance, box);
  if (!moving) {
    return std::nullopt;
  }
  Box all = moving->at_open;
  all.add(moving->at_close.lo);
  all.add(moving->at_close.hi);
  return all;
}

}  // namespace

Ball moving_ball(const Geometry& geometry, PrimitiveId id) {
  const Instance& instance = geometry.instances[id.instance - 1];
  const Box local = local_box(geometry, instance, id.primitive);
  // A primitive whose placement is singular cannot be hit, so any bounds are right.
  const Box box = swept(geometry, instance, local).value_or(local);
  return {0.5 * (box.lo + box.hi), length(box.hi - box.lo) / 2};
}

ShapeView shape_view(const Geometry& geometry, PrimitiveId id, double time) {
  if (id.instance == 0) {
    return view_of(geometry, id.primitive);
  }
  const Instance& instance = geometry.instances[id.instance - 1];
  const Transform to_world = to_world_at(geometry, instance, time);
  const Shapes* group = group_of(geometry, instance);
  return group != nullptr ? placed(view_of(*group, id.primitive), to_world)
                          : mesh_view(geometry, instance, id.primitive, to_world, time);
}

MaterialId material_of(const Geometry& geometry, PrimitiveId id) {
  return id.instance == 0
             ? material_of(static_cast<const Shapes&>(geometry), id.primitive)
             : material_of(geometry, geometry.instances[id.instance - 1], id.primitive);
}

}  // namespace bandsaw
