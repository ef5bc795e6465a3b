#pragma once

// A leaf of a BVH: up to eight spheres in float, or the bounding spheres of up to eight disks. The
// float test of a ray against these spheres is conservative: if it rejects a sphere, the exact test
// in double precision would reject the sphere as well. README.md, "Spheres", derives the bounds.

#include <array>
#include <cmath>
#include <cstdint>

#include "renderlib/accel/flat_filter.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct SpherePack {
  std::array<std::array<float, kPackSize>, 3> center;
  std::array<float, kPackSize> radius;             ///< rounded up
  std::array<std::uint32_t, kPackSize> primitive;  ///< index of the sphere or disk in its kind
  float reach = 0;                                 ///< at least |center|_1 + radius of every sphere
  std::uint32_t lanes = 0;                         ///< bit i: lane i is used

  /// Adds a sphere; the pack MUST have fewer than eight.
  void add(const Sphere& sphere, std::uint32_t index);
};

/// Returns a mask of the lanes that may be hit before `bound`, which is FloatRay::above() of a
/// distance.
template <class Float = Float8>
inline unsigned filter_spheres(const SpherePack& pack, const FloatRay& ray, float bound) {
  constexpr float kError = 16 * 0x1p-24f;
  const Vector8<Float> d = {Float(ray.direction[0]), Float(ray.direction[1]),
                            Float(ray.direction[2])};
  const float length = ray.length;
  const Vector8<Float> c = {Float::load(pack.center[0].data()) - Float(ray.origin[0]),
                            Float::load(pack.center[1].data()) - Float(ray.origin[1]),
                            Float::load(pack.center[2].data()) - Float(ray.origin[2])};
  // With c from the ray's origin to the centre: |cross(c, d)| is the distance of the centre from
  // the ray, and dot(c, d) its place along the ray, both times |d|. `slack` bounds the rounding of
  // both.
  const Vector8<Float> off = cross(c, d);
  const Float along = dot(c, d);
  const Float reach = abs(c.x) + abs(c.y) + abs(c.z) + Float(ray.origin_size) + Float(pack.reach);
  const Float slack =
      about_fused(Float(kError * ray.direction_size), reach, Float(0x1p20f * ray.floor));
  const Float radius = about_fused(Float::load(pack.radius.data()), Float(length), slack);
  const Float square = radius * radius * Float(1 + 0x1p-20f);
  // Hits are confined to a sphere's box, whose corners are sqrt(3) radii from the centre.
  const Float half = Float(1.8f) * radius;
  const Float limit(bound * length * length * (1 + 0x1p-20f));
  const unsigned missed =
      ((square < dot(off, off)) | (along + half < Float(0.0f)) | (limit < along - half)).bits();
  return pack.lanes & ~missed;
}

}  // namespace bandsaw
