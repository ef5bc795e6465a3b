#pragma once

// The directions in which a point sees a triangle, uniform in solid angle: Arvo 1995, "Stratified
// Sampling of Spherical Triangles". The solid angle is that of Van Oosterom and Strackee 1983, "The
// Solid Angle of a Plane Triangle", whose numerator is a volume and keeps its digits; angles come
// from atan2 of a cross and a dot product.

#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

class SphericalTriangle {
 public:
  /// Below, the triangle is small or a sliver: the inversion has few digits left, and uniform by
  /// area is nearly uniform in solid angle. Steradians.
  static constexpr double kLeastSolidAngle = 1e-3;

  /// The triangle a, a + u, a + v as `point` sees it. Nothing when it is seen under less than
  /// kLeastSolidAngle or edge-on: then sample its area.
  static std::optional<SphericalTriangle> seen_from(const Vec3& point, const Vec3& a, const Vec3& u,
                                                    const Vec3& v);

  /// Steradians. The density of each direction is 1 / solid_angle.
  double solid_angle() const { return solid_angle_; }

  /// Coordinates (s, t), s, t >= 0, s + t <= 1, of the point a + s u + t v of the triangle in the
  /// sampled direction.
  Vec2 sample(double s, double t) const;

 private:
  SphericalTriangle() = default;
  Vec2 on_plane(const Vec3& direction) const;

  Vec3 to_a_;  ///< from the point
  Vec3 u_;
  Vec3 v_;
  Vec3 a_;  ///< unit directions of the vertices
  Vec3 b_;
  Vec3 toward_c_;         ///< at a, unit: where c lies
  double cos_c_ = 0;      ///< of the side from a to b
  double sin_alpha_ = 0;  ///< of the angle at a
  double cos_alpha_ = 0;
  double solid_angle_ = 0;
};

}  // namespace bandsaw
