#pragma once

// Samples a triangle as seen from a point, uniformly in solid angle: Arvo 1995, "Stratified
// Sampling of Spherical Triangles". The solid angle is computed with the formula of Van
// Oosterom and Strackee 1983, "The Solid Angle of a Plane Triangle". The numerator of this formula
// is a volume, which keeps its precision. The sine of the angle at vertex a comes from a cross
// product, and the cosine from a dot product.

#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

class SphericalTriangle {
 public:
  /// Minimum solid angle in steradians. A triangle below this limit is small or a sliver. For such
  /// a triangle the inversion loses precision, and sampling it uniformly by area is nearly uniform
  /// in solid angle.
  static constexpr double kMinSolidAngle = 1e-3;

  /// Creates the triangle a, a + u, a + v as seen from `point`. Returns std::nullopt if the solid
  /// angle of the triangle is below kMinSolidAngle or if the triangle is seen edge-on. The caller
  /// then samples the area of the triangle instead.
  static std::optional<SphericalTriangle> seen_from(const Vec3& point, const Vec3& a, const Vec3& u,
                                                    const Vec3& v);

  /// Returns the solid angle in steradians. The pdf of every direction is 1 / solid_angle().
  double solid_angle() const { return solid_angle_; }

  /// Returns the coordinates (s, t), with s, t >= 0 and s + t <= 1, of the triangle's point a + s u
  /// + t v in the sampled direction.
  Vec2 sample(double s, double t) const;

 private:
  SphericalTriangle() = default;
  /// Returns the coordinates (s, t) of the triangle's point in this direction, clamped to the
  /// triangle.
  Vec2 on_plane(const Vec3& direction) const;

  Vec3 to_a_;  ///< from the point to vertex a
  Vec3 u_;
  Vec3 v_;
  Vec3 a_;                ///< unit direction to vertex a
  Vec3 b_;                ///< unit direction to vertex b
  Vec3 toward_c_;         ///< unit tangent at a, towards c
  double cos_c_ = 0;      ///< cosine of the side from a to b
  double sin_alpha_ = 0;  ///< sine of the angle at a
  double cos_alpha_ = 0;  ///< cosine of the angle at a
  double solid_angle_ = 0;
};

}  // namespace bandsaw
