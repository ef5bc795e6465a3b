#pragma once

// What surface.cpp is made of: surfaces of loose shapes in their own space, and how placements
// treat normals.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "renderlib/geometry/surface.h"

namespace bandsaw {

/// Whether `v` has a direction: it is neither zero nor infinite nor NaN.
inline bool has_direction(const Vec3& v) { return max_abs(v) > 0 && is_finite(v); }
/// `v` times a power of two, exact: its longest component is in [1, 4), or as `v` has it where that
/// is zero, infinite or below 2^-1023.
inline Vec3 near_one(const Vec3& v) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(max_abs(v)) >> 52;
  return v * std::bit_cast<double>((2046 - std::min<std::uint64_t>(exponent, 2045)) << 52);
}
/// The unit vector along `v`, which has a direction; v may be of any length.
inline Vec3 unit(const Vec3& v) {
  const Vec3 scaled = near_one(v);
  return scaled * (1 / length(scaled));
}
/// The unit vector along `v`, or `otherwise` where v has no direction.
inline Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  return has_direction(v) ? unit(v) : otherwise;
}
/// The unit normal along `v`, or where v has no direction one that faces the ray.
inline Vec3 unit_normal(const Vec3& v, const Ray& ray) {
  return has_direction(v) ? unit(v) : unit_or(-ray.direction, {0, 0, 1});
}
inline Vec3 same_side(const Vec3& n, const Vec3& reference) {
  return dot(n, reference) < 0 ? -n : n;
}
/// Across two edges, of any length; zero or not finite where they are parallel.
Vec3 across(const Vec3& e1, const Vec3& e2);
/// The unit normal of a triangle with these edges; a triangle without area faces the ray.
inline Vec3 flat_normal(const Vec3& e1, const Vec3& e2, const Ray& ray) {
  return unit_normal(across(e1, e2), ray);
}

/// What prepare_surfaces does to each space.
void prepare_normals(Shapes& shapes);

/// How the linear part of a placement treats normals and lengths.
struct Placement {
  explicit Placement(const Transform& t);
  /// M^-T n times |det M|: normals stay outside in mirrored placements too.
  Vec3 normal(const Vec3& n) const {
    const Vec3 c = {dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)};
    return determinant < 0 ? -c : c;
  }
  /// Sets `squashed` and `offset` of `placed`, and `away` where it is squashed. The position is
  /// set; `local` is the same surface before the placement.
  void set_offset(const SurfacePoint& local, SurfacePoint& placed) const;

  std::array<Vec3, 3> rows;
  std::array<Vec3, 3> cofactors;
  double determinant;
  /// Whether lengths of different directions are changed by so different factors that the rounding
  /// of rays that come back to the primitive's own space counts there.
  bool squashes;
  double moved;  ///< the largest component of the translation
};

/// Of a shape in the space it lies in; `ray` is in that space. `sphere_uv`: as surface_at.
SurfacePoint on_shape(const Shapes& shapes, const Ray& ray, const Hit& hit, bool sphere_uv);

/// A surface in a space of its own, in the world.
SurfacePoint placed(const SurfacePoint& local, const Transform& to_world, const Ray& world_ray);

}  // namespace bandsaw
