#pragma once

// Samples a rectangle as seen from a point, uniformly in solid angle: Urena, Fajardo and King 2013,
// "An Area-Preserving Parametrization for Spherical Rectangles". The solid angle is a sum of asin,
// as in Cycles. The paper's sum of acos would lose its precision for small rectangles.

#include <array>
#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns true if u and v are perpendicular: the cosine of their angle is at most 1e-9 in
/// magnitude. Only then may a quad be sampled as a spherical rectangle.
bool is_rectangle(const Vec3& u, const Vec3& v);

class SphericalRectangle {
 public:
  /// Creates the rectangle corner + a u + b v as seen from `point`; is_rectangle(u, v) MUST be
  /// true. Returns std::nullopt if the solid angle is below 1e-9 steradians or if the rectangle is
  /// seen exactly edge-on. The caller then samples the rectangle's area instead.
  static std::optional<SphericalRectangle> seen_from(const Vec3& point, const Vec3& corner,
                                                     const Vec3& u, const Vec3& v);

  /// Returns the solid angle in steradians. The pdf of every direction is 1 / solid_angle().
  double solid_angle() const { return solid_angle_; }

  /// Returns the coordinates (a, b) in [0, 1]^2 of the rectangle's point in the sampled direction.
  Vec2 sample(double u, double v) const;

 private:
  SphericalRectangle() = default;
  /// The rectangle [x0, x1] x [y0, y1] in the plane z = z0 < 0, with the point at the origin.
  double x0_ = 0;
  double x1_ = 0;
  double y0_ = 0;
  double y1_ = 0;
  double z0_ = 0;
  double b0_ = 0;     ///< z component of the normal of the plane through the origin and edge y0
  double b1_ = 0;     ///< z component of the normal of the plane through the origin and edge y1
  double angle_ = 0;  ///< sum of the asins for the two corners at x0
  double solid_angle_ = 0;
};

}  // namespace bandsaw
