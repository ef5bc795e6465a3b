#pragma once

// The directions in which a point sees a rectangle, uniform in solid angle: Urena, Fajardo, King
// 2013, "An Area-Preserving Parametrization for Spherical Rectangles". The solid angle is summed
// from asin as Cycles does, not acos: a small rectangle keeps its digits.

#include <array>
#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Whether u and v are at right angles, as far as double can tell; only then is a quad seen as a
/// spherical rectangle.
bool is_rectangle(const Vec3& u, const Vec3& v);

class SphericalRectangle {
 public:
  /// The rectangle corner + a u + b v as `point` sees it; is_rectangle(u, v). Nothing when it is
  /// seen under less than 1e-9 steradians or exactly edge-on: then sample its area.
  static std::optional<SphericalRectangle> seen_from(const Vec3& point, const Vec3& corner,
                                                     const Vec3& u, const Vec3& v);

  /// Steradians. The density of each direction is 1 / solid_angle.
  double solid_angle() const { return solid_angle_; }

  /// The coordinates (a, b) in [0, 1]^2 of the point of the rectangle in the sampled direction.
  Vec2 sample(double u, double v) const;

 private:
  SphericalRectangle() = default;
  double x0_ =
      0;  ///< the rectangle [x0, x1] x [y0, y1] in the plane z = z0 < 0, the point at the origin
  double x1_ = 0;
  double y0_ = 0;
  double y1_ = 0;
  double z0_ = 0;
  double b0_ = 0;  ///< z components of the normals of the edges' planes
  double b1_ = 0;
  double angle_ = 0;  ///< sum of the asins of the two corners at x1
  double solid_angle_ = 0;
};

}  // namespace bandsaw
