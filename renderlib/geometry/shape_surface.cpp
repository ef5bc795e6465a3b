// on_shape() computes the surface at a hit in the space of the shape, and placed() transforms it to
// the world. The origins of rays that leave the surface are moved by an offset, so that they do not
// hit the same surface again because of rounding. A placement squashes space if its condition
// number is above kMaxPlainCondition; then the origin is moved along the normal in the space of the
// shape.

#include "renderlib/geometry/shape_surface.h"

#include <algorithm>
#include <cmath>

#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/sphere_uv.h"

namespace bandsaw {
namespace {

/// Offset of ray origins, relative to the largest number from which the position was computed.
/// README.md, "Squashed space", derives this constant and the next two.
constexpr double kOffset = 0x1p-40;
/// Up to this condition number of a placement, kOffset is far above the rounding of rays that are
/// transformed back to the primitive's own space.
constexpr double kMaxPlainCondition = 0x1p8;
/// Above that condition number, this share of kOffset suffices in the primitive's own space.
constexpr double kSquashedShare = 0x1p-5;

/// Returns the Frobenius norm of the matrix with the rows `m`.
double norm(const std::array<Vec3, 3>& m) {
  return std::sqrt(length_squared(m[0]) + length_squared(m[1]) + length_squared(m[2]));
}

/// Returns the surface at a hit on a sphere, in the sphere's space. If `with_uv` is false, uv and
/// uv2 are zero.
SurfacePoint on_sphere(const Sphere& sphere, const Ray& ray, const Hit& hit, bool with_uv) {
  const Vec3 outward = (ray.origin - sphere.center) + ray.direction * hit.t;
  SurfacePoint p;
  p.geometric_normal = unit_normal(outward, ray);
  p.shading_normal = p.geometric_normal;
  p.position = sphere.center + p.geometric_normal * sphere.radius;
  p.object_position = p.geometric_normal * sphere.radius;
  if (with_uv) {
    p.uv = sphere_uv(p.geometric_normal);
    p.uv2 = p.uv;
  }
  p.material = sphere.material;
  p.offset = surface_offset(p.position, sphere.radius + max_abs(sphere.center));
  return p;
}

/// Returns the surface of a triangle or quad with corner `a` and edges `e1` and `e2`. `ready`
/// points to the unit normal that prepare_normals() has stored, which is zero if the shape has no
/// area. It is nullptr if no normals are stored.
SurfacePoint on_flat(const Vec3& a, const Vec3& e1, const Vec3& e2, const Vec3* ready,
                     MaterialId material, const Ray& ray, const Hit& hit) {
  SurfacePoint p;
  p.position = a + hit.u * e1 + hit.v * e2;
  p.geometric_normal = ready != nullptr && *ready != Vec3{} ? *ready : flat_normal(e1, e2, ray);
  p.shading_normal = p.geometric_normal;
  p.object_position = p.position;
  p.uv = {hit.u, hit.v};
  p.uv2 = p.uv;
  p.material = material;
  p.offset = surface_offset(p.position, max_abs(a) + std::max(max_abs(e1), max_abs(e2)));
  return p;
}

/// Returns the surface at a hit on a disk, in the disk's space.
SurfacePoint on_disk(const Disk& disk, const Hit& hit) {
  const DiskAxes axes = axes_of(disk);
  SurfacePoint p;
  p.position = disk.center + axes.u * (hit.u * disk.radius) + axes.v * (hit.v * disk.radius);
  p.geometric_normal = normalize(disk.normal);
  p.shading_normal = p.geometric_normal;
  p.object_position = p.position;
  p.uv = {(hit.u + 1) / 2, (hit.v + 1) / 2};
  p.uv2 = p.uv;
  p.material = disk.material;
  p.offset = surface_offset(p.position, disk.radius + max_abs(disk.center));
  return p;
}

}  // namespace

Vec3 across(const Vec3& e1, const Vec3& e2) { return cross(near_one(e1), near_one(e2)); }

void prepare_normals(Shapes& shapes) {
  shapes.flat_normals.clear();
  shapes.flat_normals.reserve(shapes.quads.size() + shapes.triangles.size());
  for (const Quad& quad : shapes.quads) {
    shapes.flat_normals.push_back(unit_or(across(quad.u, quad.v), {}));
  }
  for (const Triangle& t : shapes.triangles) {
    shapes.flat_normals.push_back(unit_or(across(t.b - t.a, t.c - t.a), {}));
  }
}

Placement::Placement(const Transform& t) {
  for (std::size_t i = 0; i < 3; ++i) {
    rows[i] = {t.m[i][0], t.m[i][1], t.m[i][2]};
  }
  for (std::size_t i = 0; i < 3; ++i) {
    cofactors[i] = cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
  }
  determinant = dot(rows[0], cofactors[0]);
  // The condition number is |M| |M^-1| = norm(rows) norm(cofactors) / |determinant|. This quotient
  // is above the limit even if the determinant consists only of rounding error.
  squashes = !(norm(rows) * norm(cofactors) <= kMaxPlainCondition * std::abs(determinant));
  if (squashes) {
    for (std::size_t i = 0; i < 3; ++i) {
      cofactors[i] = exact_cross(rows[(i + 1) % 3], rows[(i + 2) % 3]);
    }
    determinant = dot(rows[0], cofactors[0]);
  }
  moved = max_abs(Vec3{t.m[0][3], t.m[1][3], t.m[2][3]});
}

// The rounding error of a ray's origin in the world is a few 2^-53 of `scale`, the largest number
// from which the position was computed. When the ray is transformed back to the primitive's own
// space, the error grows by up to |M^-1| = norm(cofactors) / |determinant|, where M is the linear
// part of the placement. In squashed space the origin is therefore moved along the normal of the
// primitive's own space, by the distance kOffset kSquashedShare `scale` |M^-1|. In the world this
// is the vector `away`, whose component along the world's normal is `offset`. README.md, "Squashed
// space", derives the constants.
void Placement::set_offset(const SurfacePoint& local, SurfacePoint& placed) const {
  const double largest_in_object = local.offset / kOffset;
  const double scale = std::max({max_abs(placed.position), largest_in_object * norm(rows), moved});
  placed.squashed = squashes;
  if (!squashes) {
    placed.offset = surface_offset({}, scale);
    return;
  }
  const double normal_length = length(normal(local.geometric_normal));
  placed.offset = surface_offset({}, kSquashedShare * scale * norm(cofactors) / normal_length);
  const Vec3 own_normal = {dot(rows[0], local.geometric_normal),
                           dot(rows[1], local.geometric_normal),
                           dot(rows[2], local.geometric_normal)};
  placed.away = own_normal * (placed.offset * normal_length / std::abs(determinant));
}

double surface_offset(const Vec3& position, double size) {
  return kOffset * std::max(max_abs(position), size);
}

SurfacePoint on_shape(const Shapes& shapes, const Ray& ray, const Hit& hit, bool sphere_uv) {
  const auto [kind, index] = shape_ref(shapes, hit.id.primitive);
  const auto ready = [&](std::size_t flat) {
    return shapes.flat_normals.empty() ? nullptr : &shapes.flat_normals[flat];
  };
  switch (kind) {
    case ShapeKind::kSphere:
      return on_sphere(shapes.spheres[index], ray, hit, sphere_uv);
    case ShapeKind::kQuad: {
      const Quad& quad = shapes.quads[index];
      return on_flat(quad.corner, quad.u, quad.v, ready(index), quad.material, ray, hit);
    }
    case ShapeKind::kTriangle: {
      const Triangle& t = shapes.triangles[index];
      const Vec3* const normal = ready(shapes.quads.size() + index);
      return on_flat(t.a, t.b - t.a, t.c - t.a, normal, t.material, ray, hit);
    }
    case ShapeKind::kDisk:
      break;
  }
  return on_disk(shapes.disks[index], hit);
}

SurfacePoint placed(const SurfacePoint& local, const Transform& to_world, const Ray& world_ray) {
  const Placement placement(to_world);
  SurfacePoint p = local;
  p.position = to_world.point(local.position);
  p.geometric_normal = unit_normal(placement.normal(local.geometric_normal), world_ray);
  p.shading_normal =
      local.shading_normal == local.geometric_normal
          ? p.geometric_normal
          : same_side(unit_or(placement.normal(local.shading_normal), p.geometric_normal),
                      p.geometric_normal);
  placement.set_offset(local, p);
  return p;
}

}  // namespace bandsaw
