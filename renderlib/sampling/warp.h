#pragma once

// Maps from numbers in [0, 1)^2 (or ^3) to points and directions, each with the density it has. All
// are closed forms: the same number of dimensions for every sample, stratification kept. Directions
// are unit vectors, z up in their own frame (sampling/basis.h). Densities are with respect to area,
// solid angle or volume, as their names say.

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Uniform on the unit disk (concentric map: Shirley and Chiu 1997).
Vec2 sample_disk(double u, double v);
inline constexpr double kDiskAreaPdf = kInvPi;

/// cos(theta) / pi over the hemisphere z >= 0. z is > 0 for every u, v.
Vec3 sample_cosine_hemisphere(double u, double v);
constexpr double cosine_hemisphere_pdf(double cos_theta) {
  return cos_theta > 0 ? cos_theta * kInvPi : 0;
}

/// Uniform over all directions.
Vec3 sample_sphere(double u, double v);
inline constexpr double kSpherePdf = 0.25 * kInvPi;

/// Uniform in the unit ball, density 3 / (4 pi) by volume.
Vec3 sample_ball(double u, double v, double w);
inline constexpr double kBallPdf = 0.75 * kInvPi;

/// Uniform over the directions within a cone around z, given as 1 - cos of its half-angle, in (0,
/// 2]. (The cosine itself would lose a narrow cone to rounding.)
Vec3 sample_cone(double u, double v, double one_minus_cos);
constexpr double cone_pdf(double one_minus_cos) { return 0.5 * kInvPi / one_minus_cos; }

/// 1 - cos of an angle from the square of its sine, in [0, 1], without cancellation: angles up to
/// 90 degrees.
inline double one_minus_cos_from_sin2(double sin2) {
  return sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
}

/// A density by area at `to`, whose unit normal is `normal`, as a density by solid angle of the
/// direction from `from`; infinite where that direction lies in the surface.
inline double solid_angle_pdf(double area_pdf, const Vec3& from, const Vec3& to,
                              const Vec3& normal) {
  const Vec3 way = to - from;
  const double distance2 = length_squared(way);
  return area_pdf * distance2 * std::sqrt(distance2) / std::abs(dot(way, normal));
}

/// How to weigh a sample of density p that another technique makes with density q: p^2 / (p^2 +
/// q^2), p > 0, no overflow. (Power heuristic: Veach 1997, section 9.2.3.)
inline double power_heuristic(double p, double q) {
  const double ratio = q / p;
  return 1 / (1 + ratio * ratio);
}

}  // namespace bandsaw
