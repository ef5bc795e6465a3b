#pragma once

// Conservative float test of a ray against eight triangles: if the float test rejects a triangle,
// the exact test in double precision would reject it as well. README.md, "Triangles", derives the
// bounds.

#include "renderlib/accel/flat_pack.h"
#include "renderlib/accel/float_ray.h"
#include "renderlib/base/simd.h"

namespace bandsaw {

/// Bound of the relative rounding error of a corner's weight. The weight is the corner's
/// barycentric coordinate times `volume`. `volume` is the dot product of the triangle's normal and
/// the ray's direction.
inline constexpr float kWeightError = 26 * 0x1p-24f;
/// Bound of the relative rounding error of `volume`, and of the distance times `volume`.
inline constexpr float kDistanceError = 24 * 0x1p-24f;
/// kDoubleError times a length covers the rounding of the double test.
inline constexpr float kDoubleError = 0x1p-27f;

/// Eight vectors. about_fused(a, b, c) is a b + c, and about_fused_minus(a, b, c) is a b - c; both
/// are rounded once or twice, depending on the machine (base/simd_plain.h).
template <class Float>
struct Vector8 {
  Float x;
  Float y;
  Float z;

  friend Vector8 operator-(const Vector8& a, const Vector8& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend Vector8 cross(const Vector8& a, const Vector8& b) {
    return {about_fused_minus(a.y, b.z, a.z * b.y), about_fused_minus(a.z, b.x, a.x * b.z),
            about_fused_minus(a.x, b.y, a.y * b.x)};
  }
  friend Float dot(const Vector8& a, const Vector8& b) {
    return about_fused(a.x, b.x, about_fused(a.y, b.y, a.z * b.z));
  }
};

/// Results of filter_flats(): bit i stands for the triangle in lane i of the pack.
struct FlatLanes {
  unsigned maybe = 0;   ///< may be hit
  unsigned surely = 0;  ///< is certainly hit; a subset of `maybe`
};

/// Finds the triangles that may be hit before `bound`, and those that are certainly hit at a t in
/// (0, sure_bound). If `sure_bound` is 0, the result has no triangles that are certainly hit. Both
/// bounds are distances along the ray times FloatRay::scale: FloatRay::above() computes `bound`,
/// and FloatRay::below() computes `sure_bound`. README.md, "Triangles", gives the formulas.
template <class Float = Float8>
[[gnu::always_inline]] inline FlatLanes filter_flats(const FlatPack& pack, const FloatRay& ray,
                                                     float bound, float sure_bound) {
  const auto corner = [&pack](std::size_t which) {
    return Vector8<Float>{Float::load(pack.corner[3 * which].data()),
                          Float::load(pack.corner[3 * which + 1].data()),
                          Float::load(pack.corner[3 * which + 2].data())};
  };
  const Vector8<Float> d = {Float(ray.direction[0]), Float(ray.direction[1]),
                            Float(ray.direction[2])};
  const Vector8<Float> o = {Float(ray.origin[0]), Float(ray.origin[1]), Float(ray.origin[2])};
  const Vector8<Float> a = corner(0);
  const Vector8<Float> e1 = corner(1) - a;
  const Vector8<Float> e2 = corner(2) - a;
  const Vector8<Float> c = a - o;
  const Vector8<Float> n = cross(e1, e2);
  const Vector8<Float> r = cross(c, d);
  const Float volume = dot(n, d);
  const Float weight_b = dot(r, e2);
  const Float weight_c = Float(0.0f) - dot(r, e1);
  const Float weight_a = volume - weight_b - weight_c;

  const Float size(pack.size);
  const Float reach = abs(c.x) + abs(c.y) + abs(c.z) + Float(ray.origin_size) + size;
  const Float error = about_fused(Float(kWeightError * ray.direction_size) * reach,
                                  about_fused(Float(kDoubleError), reach, size), Float(ray.floor));
  const Float minus_error = Float(0.0f) - error;
  // If any weight is NaN, weight_a is NaN as well. Then min() and max() return their second
  // operand, which is weight_a. So `least` and `most` are NaN, and the triangle is not rejected.
  const Float least = min(min(weight_b, weight_c), weight_a);
  const Float most = max(max(weight_b, weight_c), weight_a);
  const unsigned outside = ((least < minus_error) & (error < most)).bits();
  const unsigned left = pack.lanes & ~outside;
  if (left == 0) {
    return {};
  }
  const unsigned inside = ((error < least) | (most < minus_error)).bits();

  // t = volume_t / volume. It is used only where the weights are certain.
  const Float volume_t = flip_by_sign(dot(n, c), volume);
  const Float positive = abs(volume);
  const Float per_length =
      Float(kDistanceError) * about_fused(Float(kDoubleError) * reach, reach, size * size);
  const Float error_t = about_fused(per_length, reach, Float(ray.floor));
  const Float error_volume = about_fused(per_length, Float(ray.direction_size), Float(ray.floor));
  const Float far = volume_t + error_t;
  const Float near = volume_t - error_t;
  const unsigned beyond =
      ((far < Float(0.0f)) | (Float(bound) * (positive + error_volume) < near)).bits();
  if (sure_bound == 0) {
    return {left & ~(inside & beyond), 0};
  }
  const unsigned between =
      ((Float(0.0f) < near) & (far < Float(sure_bound) * (positive - error_volume))).bits();
  return {left & ~(inside & beyond), left & inside & between};
}

}  // namespace bandsaw
