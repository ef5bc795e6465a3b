#pragma once

// Parts of surface.cpp: surfaces of loose shapes (of no mesh) in their own space, and the effect of
// placements on normals.

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "renderlib/geometry/surface.h"

namespace bandsaw {

/// Returns true if `v` has a direction: it is neither zero nor infinite nor NaN.
inline bool has_direction(const Vec3& v) { return max_abs(v) > 0 && is_finite(v); }
/// Returns `v` times a power of two, without rounding. The largest component of the result is in
/// [1, 4), or below 1 if the largest component of `v` is below 2^-1023. Zero and infinity stay zero
/// and infinity.
inline Vec3 near_one(const Vec3& v) {
  const std::uint64_t exponent = std::bit_cast<std::uint64_t>(max_abs(v)) >> 52;
  return v * std::bit_cast<double>((2046 - std::min<std::uint64_t>(exponent, 2045)) << 52);
}
/// Returns the unit vector along `v`, which MUST have a direction and may have any length.
inline Vec3 unit(const Vec3& v) {
  const Vec3 scaled = near_one(v);
  return scaled * (1 / length(scaled));
}
/// Returns the unit vector along `v`, or `otherwise` if v has no direction.
inline Vec3 unit_or(const Vec3& v, const Vec3& otherwise) {
  return has_direction(v) ? unit(v) : otherwise;
}
/// Returns the unit normal along `v`, or one that faces the ray if v has no direction.
inline Vec3 unit_normal(const Vec3& v, const Ray& ray) {
  return has_direction(v) ? unit(v) : unit_or(-ray.direction, {0, 0, 1});
}
/// Returns n or -n, whichever is in the hemisphere of `reference`.
inline Vec3 same_side(const Vec3& n, const Vec3& reference) {
  return dot(n, reference) < 0 ? -n : n;
}
/// Returns a vector perpendicular to two edges, of any length; zero or not finite if they are
/// parallel.
Vec3 across(const Vec3& e1, const Vec3& e2);
/// Returns the unit normal of a triangle with these edges. The normal of a triangle without area
/// faces the ray.
inline Vec3 flat_normal(const Vec3& e1, const Vec3& e2, const Ray& ray) {
  return unit_normal(across(e1, e2), ray);
}

/// Precomputes the unit normals of the quads and triangles of one space (Shapes::flat_normals).
void prepare_normals(Shapes& shapes);

/// Effect of a placement p -> M p + t on normals and lengths.
struct Placement {
  explicit Placement(const Transform& t);
  /// Returns M^-T n times |det M|, so that normals point outside in mirrored placements too.
  Vec3 normal(const Vec3& n) const {
    const Vec3 c = {dot(cofactors[0], n), dot(cofactors[1], n), dot(cofactors[2], n)};
    return determinant < 0 ? -c : c;
  }
  /// Sets the members of `placed` that keep the origins of rays off the surface: `squashed`,
  /// `offset`, and also `away` if the placement squashes. The position of `placed` MUST be set.
  /// `local` is the same surface before the placement.
  void set_offset(const SurfacePoint& local, SurfacePoint& placed) const;

  std::array<Vec3, 3> rows;       ///< of M
  std::array<Vec3, 3> cofactors;  ///< rows of the cofactor matrix of M
  double determinant;             ///< of M
  /// True if the condition number of the placement is so large that rounding matters in rays that
  /// are transformed back to the primitive's own space (README.md, "Squashed space").
  bool squashes;
  double moved;  ///< the largest component of the translation
};

/// Returns the surface of a shape in its own space; `ray` is in that space too. If `sphere_uv` is
/// false, the uvs of spheres are zero, as in surface_at().
SurfacePoint on_shape(const Shapes& shapes, const Ray& ray, const Hit& hit, bool sphere_uv);

/// Returns the surface `local`, transformed from the primitive's own space to world space.
/// `world_ray` is the ray that hit the surface.
SurfacePoint placed(const SurfacePoint& local, const Transform& to_world, const Ray& world_ray);

}  // namespace bandsaw
