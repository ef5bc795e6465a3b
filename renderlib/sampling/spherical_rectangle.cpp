// Samples a rectangle uniformly in solid angle (Ureña, Fajardo and King 2013), with formulas that
// do not cancel for small rectangles.

#include "renderlib/sampling/spherical_rectangle.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Largest cosine of an angle that counts as a right angle.
constexpr double kRightAngle = 1e-9;
/// Below this solid angle, in steradians, the inversion loses precision, and area sampling is
/// equally good.
constexpr double kMinSolidAngle = 1e-9;

}  // namespace

bool is_rectangle(const Vec3& u, const Vec3& v) {
  return std::abs(dot(u, v)) <= kRightAngle * std::sqrt(length_squared(u) * length_squared(v));
}

std::optional<SphericalRectangle> SphericalRectangle::seen_from(const Vec3& point,
                                                                const Vec3& corner, const Vec3& u,
                                                                const Vec3& v) {
  const double width = length(u);
  const double height = length(v);
  const Vec3 x = u / width;
  const Vec3 y = v / height;
  const Vec3 to_corner = corner - point;
  SphericalRectangle r;
  r.x0_ = dot(to_corner, x);
  r.x1_ = r.x0_ + width;
  r.y0_ = dot(to_corner, y);
  r.y1_ = r.y0_ + height;
  r.z0_ = -std::abs(dot(to_corner, cross(x, y)));
  const double z2 = r.z0_ * r.z0_;
  // z components of the unit normals of the planes through the point and each edge, in the order
  // y0, x1, y1, x0. For two adjacent planes, z is the only component that is not 0 in both normals.
  // So the product of their z components is the cosine of the angle between the normals.
  const std::array<double, 4> n = {
      -r.y0_ / std::sqrt(r.y0_ * r.y0_ + z2), r.x1_ / std::sqrt(r.x1_ * r.x1_ + z2),
      r.y1_ / std::sqrt(r.y1_ * r.y1_ + z2), -r.x0_ / std::sqrt(r.x0_ * r.x0_ + z2)};
  r.b0_ = n[0];
  r.b1_ = n[2];
  r.angle_ = asin(n[2] * n[3]) + asin(n[3] * n[0]);
  r.solid_angle_ = asin(n[0] * n[1]) + asin(n[1] * n[2]) + r.angle_;
  if (!(r.z0_ < 0) || !(r.solid_angle_ >= kMinSolidAngle)) {
    return std::nullopt;
  }
  return r;
}

Vec2 SphericalRectangle::sample(double u, double v) const {
  // Section 4 of the paper, with phi_u = pi + phi: x is chosen so that the part of the rectangle up
  // to x has the share u of the solid angle.
  const SinCos phi = sincos_turns((u * solid_angle_ - angle_) * (0.5 * kInvPi));
  const double f = (phi.cos * b0_ + b1_) / phi.sin;
  // x = |z0| c / sqrt(1 - c^2) with c = 1 / sqrt(f^2 + b0^2), and 1 - b0^2 = g^2.
  const double g = -z0_ / std::sqrt(y0_ * y0_ + z0_ * z0_);
  const double size = std::abs(f);
  const double x_size = -z0_ / std::sqrt(std::max(0.0, (size - g) * (size + g)));
  const double x = std::clamp(std::isnan(f) ? 0 : std::copysign(x_size, f), x0_, x1_);
  const double d2 = x * x + z0_ * z0_;
  const double h0 = y0_ / std::sqrt(d2 + y0_ * y0_);
  const double h1 = y1_ / std::sqrt(d2 + y1_ * y1_);
  const double h = h0 + v * (h1 - h0);
  const double y_raw = h * std::sqrt(d2 / std::max(0.0, (1 - h) * (1 + h)));
  const double y = std::clamp(y_raw, y0_, y1_);
  return {std::clamp((x - x0_) / (x1_ - x0_), 0.0, 1.0),
          std::clamp((y - y0_) / (y1_ - y0_), 0.0, 1.0)};
}

}  // namespace bandsaw
