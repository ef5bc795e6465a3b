#pragma once

// Fresnel equations for a smooth boundary between two transparent media, in double. Born and Wolf,
// "Principles of Optics", section 1.5.2.

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns w mirrored about the unit normal n; both point away from the surface.
inline Vec3 mirrored(const Vec3& w, const Vec3& n) { return 2 * dot(w, n) * n - w; }

/// Returns the cosine of the angle of refraction; std::nullopt on total internal reflection. cos_i
/// is in [0, 1]; eta is the index beyond the boundary over the index on this side.
inline std::optional<double> refracted_cos(double cos_i, double eta) {
  // 1 - (1 - cos_i^2) / eta^2, without cancellation at grazing angles between media of nearly equal
  // index.
  const double cos2_t = ((eta - 1) * (eta + 1) + cos_i * cos_i) / (eta * eta);
  if (cos2_t <= 0) {
    return std::nullopt;
  }
  return std::sqrt(std::min(1.0, cos2_t));
}

/// Returns the refracted direction of w (unit, away from the surface, on the side of n), a unit
/// vector up to rounding. cos_t is the result of refracted_cos().
inline Vec3 refracted(const Vec3& w, const Vec3& n, double cos_t, double eta) {
  return (dot(w, n) / eta - cos_t) * n - w / eta;
}

/// Returns the reflectance of unpolarised light, in [0, 1]; 1 on total internal reflection and at
/// grazing incidence.
inline double fresnel(double cos_i, double eta) {
  const std::optional<double> cos_t = refracted_cos(cos_i, eta);
  if (!cos_t || cos_i <= 0) {
    return 1;
  }
  const double parallel = (eta * cos_i - *cos_t) / (eta * cos_i + *cos_t);
  const double perpendicular = (cos_i - eta * *cos_t) / (cos_i + eta * *cos_t);
  return 0.5 * (parallel * parallel + perpendicular * perpendicular);
}

/// Returns the reflectance of a metal in air for unpolarised light (Born and Wolf, section 14.2):
/// eta and k are the real and imaginary part of its index, cos_i is in [0, 1].
inline double conductor_fresnel(double cos_i, double eta, double k) {
  const double cos2 = cos_i * cos_i;
  const double sin2 = 1 - cos2;
  const double real = eta * eta - k * k - sin2;
  const double size = std::sqrt(real * real + 4 * eta * eta * k * k);
  const double twice_a = 2 * std::sqrt(std::max(0.0, 0.5 * (size + real))) * cos_i;
  const double perpendicular = (size + cos2 - twice_a) / (size + cos2 + twice_a);
  const double along = cos2 * size + sin2 * sin2;
  const double parallel = perpendicular * (along - twice_a * sin2) / (along + twice_a * sin2);
  return 0.5 * (perpendicular + parallel);
}

/// Returns the Jacobian of refraction (Walter et al. 2007, eq. 17) times dot(o, h). The pdf of wi
/// by refraction at a facet is this result, times facet_pdf_over_cos() of the facet, times the
/// facet's transmittance 1 - F. o is wo, i is wi, and h is the normal of the facet. o_h and i_h are
/// dot(o, h) > 0 and dot(i, h) < 0.
inline double refraction_jacobian(double o_h, double i_h, double eta) {
  const double along_half = o_h + eta * i_h;
  return eta * eta * std::abs(i_h) * o_h / (along_half * along_half);
}

/// Returns (1 - cos)^5. In Schlick 1994, "An Inexpensive BRDF Model for Physically-based
/// Rendering", eq. 15, the reflectance is f0 + (1 - f0) times this.
inline double schlick_rim(double cos_i) {
  const double m = std::clamp(1 - cos_i, 0.0, 1.0);
  const double m2 = m * m;
  return m2 * m2 * m;
}

/// Reflectance of a clear coat at normal incidence, for an index of 1.5.
inline constexpr double kCoatF0 = 0.04;

/// Returns the reflectance at normal incidence; eta is the ratio of the two indices of refraction.
inline double normal_reflectance(double eta) {
  const double r = (eta - 1) / (eta + 1);
  return r * r;
}

}  // namespace bandsaw
