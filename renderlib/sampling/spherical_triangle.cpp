// Samples a triangle uniformly in solid angle (Arvo 1995).

#include "renderlib/sampling/spherical_triangle.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Returns the normalised component of `v` perpendicular to the unit vector n.
Vec3 across(const Vec3& v, const Vec3& n) { return normalize(v - n * dot(v, n)); }

/// Returns the square root, or 0 if rounding has made `square` negative.
double root(double square) { return std::sqrt(std::max(0.0, square)); }

}  // namespace

std::optional<SphericalTriangle> SphericalTriangle::seen_from(const Vec3& point, const Vec3& a,
                                                              const Vec3& u, const Vec3& v) {
  SphericalTriangle t;
  t.to_a_ = a - point;
  t.u_ = u;
  t.v_ = v;
  const Vec3 to_b = t.to_a_ + u;
  const Vec3 to_c = t.to_a_ + v;
  const double la = length(t.to_a_);
  const double lb = length(to_b);
  const double lc = length(to_c);
  // tan(solid angle / 2) = volume / denominator (Van Oosterom and Strackee 1983).
  const double volume = std::abs(dot(t.to_a_, cross(u, v)));
  const double denominator =
      la * lb * lc + dot(t.to_a_, to_b) * lc + dot(to_b, to_c) * la + dot(to_c, t.to_a_) * lb;
  t.solid_angle_ = 2 * atan2(volume, denominator);
  if (!(t.solid_angle_ >= kMinSolidAngle) || !(volume > 0)) {
    return std::nullopt;
  }
  t.a_ = t.to_a_ / la;
  t.b_ = to_b / lb;
  t.cos_c_ = dot(t.a_, t.b_);
  const Vec3 toward_b = across(to_b / lb, t.a_);
  t.toward_c_ = across(to_c / lc, t.a_);
  t.sin_alpha_ = length(cross(toward_b, t.toward_c_));
  t.cos_alpha_ = dot(toward_b, t.toward_c_);
  return t.sin_alpha_ > 0 ? std::optional(t) : std::nullopt;
}

Vec2 SphericalTriangle::on_plane(const Vec3& direction) const {
  // Cramer's rule for to_a + s u + t v = r direction.
  const Vec3 p = cross(direction, v_);
  const double determinant = dot(u_, p);
  const double s = std::clamp(-dot(to_a_, p) / determinant, 0.0, 1.0);
  const double t = std::clamp(-dot(direction, cross(to_a_, u_)) / determinant, 0.0, 1.0 - s);
  return {std::isnan(s) ? 0 : s, std::isnan(t) ? 0 : t};
}

Vec2 SphericalTriangle::sample(double s, double t) const {
  // Arvo's algorithm with phi = area - alpha, where `area` is s times the solid angle. The
  // sub-triangle with the vertices a and b and the solid angle `area` has its third vertex on the
  // side from a to c of the whole triangle. First the direction `c` of this third vertex is
  // computed. Then a point between `c` and b is sampled.
  const SinCos area = sincos_turns(s * solid_angle_ * (0.5 * kInvPi));
  const double sin_phi = area.sin * cos_alpha_ - area.cos * sin_alpha_;
  const double cos_phi = area.cos * cos_alpha_ + area.sin * sin_alpha_;
  const double p = cos_phi - cos_alpha_;
  const double q = sin_phi + sin_alpha_ * cos_c_;
  const double denominator = (q * sin_phi + p * cos_phi) * sin_alpha_;
  const double raw = ((q * cos_phi - p * sin_phi) * cos_alpha_ - q) / denominator;
  const double cos_side = denominator == 0 || std::isnan(raw) ? 1 : std::clamp(raw, -1.0, 1.0);
  const Vec3 c = a_ * cos_side + toward_c_ * root((1 - cos_side) * (1 + cos_side));
  const double height = t * (1 - dot(c, b_));  // 1 - cosine of the angle to b
  const Vec3 toward = c - b_ * dot(c, b_);
  const double size = length(toward);
  const Vec3 direction =
      size > 0 ? b_ * (1 - height) + toward * (root(height * (2 - height)) / size) : b_;
  return on_plane(direction);
}

}  // namespace bandsaw
