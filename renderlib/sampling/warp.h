#pragma once

// Maps from [0, 1)^2 or [0, 1)^3 to points and directions, each with its pdf. All are closed forms,
// so every sample uses the same number of dimensions and stratification is preserved. Directions
// are unit vectors in a local frame with z up (sampling/basis.h). Pdfs are with respect to area,
// solid angle or volume, as their names say.

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Samples the unit disk uniformly (concentric map: Shirley and Chiu 1997).
Vec2 sample_disk(double u, double v);
inline constexpr double kDiskAreaPdf = kInvPi;

/// Samples the hemisphere z > 0 with pdf cos(theta) / pi. z is > 0 for every u, v.
Vec3 sample_cosine_hemisphere(double u, double v);
constexpr double cosine_hemisphere_pdf(double cos_theta) {
  return cos_theta > 0 ? cos_theta * kInvPi : 0;
}

/// Samples all directions uniformly.
Vec3 sample_sphere(double u, double v);
inline constexpr double kSpherePdf = 0.25 * kInvPi;

/// Samples the unit ball uniformly, with pdf 3 / (4 pi) by volume.
Vec3 sample_ball(double u, double v, double w);
inline constexpr double kBallPdf = 0.75 * kInvPi;

/// Samples the directions within a cone around z uniformly. The cone is given as 1 - cos of its
/// half-angle, in (0, 2], because the cosine itself loses the precision of a narrow cone.
Vec3 sample_cone(double u, double v, double one_minus_cos);
constexpr double cone_pdf(double one_minus_cos) { return 0.5 * kInvPi / one_minus_cos; }

/// Returns 1 - cos of an angle of at most 90 degrees from the square of its sine, in [0, 1],
/// without cancellation.
inline double one_minus_cos_from_sin2(double sin2) {
  return sin2 / (1 + std::sqrt(std::max(0.0, 1 - sin2)));
}

/// Converts an area pdf at the point `to` of a surface to the solid-angle pdf of the direction from
/// `from` to `to`. `normal` is the surface's unit normal at `to`. If the direction lies in the
/// surface, the result is infinite.
inline double solid_angle_pdf(double area_pdf, const Vec3& from, const Vec3& to,
                              const Vec3& normal) {
  const Vec3 direction = to - from;
  const double distance2 = length_squared(direction);
  return area_pdf * distance2 * std::sqrt(distance2) / std::abs(dot(direction, normal));
}

}  // namespace bandsaw
