#include "renderlib/sampling/warp.h"

#include "renderlib/math/elementary.h"

namespace bandsaw {

Vec2 sample_disk(double u, double v) {
  const double a = 2 * u - 1;
  const double b = 2 * v - 1;
  if (a == 0 && b == 0) {
    return {0, 0};
  }
  const bool wide = std::abs(a) > std::abs(b);
  const double radius = wide ? a : b;
  // The angle is pi / 4 b / a, or pi / 2 - pi / 4 a / b.
  const SinCos angle = sincos_turns(wide ? 0.125 * (b / a) : 0.25 - 0.125 * (a / b));
  return {radius * angle.cos, radius * angle.sin};
}

Vec3 sample_cosine_hemisphere(double u, double v) {
  const Vec2 d = sample_disk(u, v);
  // On the rim rounding may leave nothing for z; a density of 0 is never sampled.
  constexpr double kLeastSquare = 0x1p-64;
  const double z = std::sqrt(std::max(kLeastSquare, 1 - d.x * d.x - d.y * d.y));
  return {d.x, d.y, z};
}

Vec3 sample_sphere(double u, double v) { return sample_cone(u, v, 2); }

Vec3 sample_ball(double u, double v, double w) { return sample_sphere(u, v) * pow(w, 1.0 / 3); }

Vec3 sample_cone(double u, double v, double one_minus_cos) {
  const double h = u * one_minus_cos;  // 1 - cos theta
  const double sin_theta = std::sqrt(std::max(0.0, h * (2 - h)));
  const SinCos angle = sincos_turns(v);
  return {sin_theta * angle.cos, sin_theta * angle.sin, 1 - h};
}

}  // namespace bandsaw
