#pragma once

// Reflection and refraction at a smooth boundary between two clear media, in double. Born and Wolf,
// "Principles of Optics", section 1.5.2.

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/math/vec.h"

namespace bandsaw {

/// w mirrored at the plane with unit normal n: both point away from the surface.
inline Vec3 mirrored(const Vec3& w, const Vec3& n) { return 2 * dot(w, n) * n - w; }

/// Cosine of the angle of refraction; nothing on total reflection. cos_i in [0, 1]; eta = index
/// beyond over index here.
inline std::optional<double> refracted_cos(double cos_i, double eta) {
  // 1 - (1 - cos_i^2) / eta^2, without cancellation at grazing angles between media that hardly
  // differ.
  const double cos2_t = ((eta - 1) * (eta + 1) + cos_i * cos_i) / (eta * eta);
  if (cos2_t <= 0) {
    return std::nullopt;
  }
  return std::sqrt(std::min(1.0, cos2_t));
}

/// The direction in which w (unit, away from the surface, on the side of n) goes on beyond the
/// surface; cos_t from refracted_cos. Unit up to rounding.
inline Vec3 refracted(const Vec3& w, const Vec3& n, double cos_t, double eta) {
  return (dot(w, n) / eta - cos_t) * n - w / eta;
}

/// The share of unpolarised light that is reflected, in [0, 1]; 1 on total reflection and at
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

/// (1 - cos)^5: Schlick 1994, "An Inexpensive BRDF Model for Physically-based Rendering", eq. 15,
/// is f0 + (1 - f0) times this.
inline double schlick_rim(double cos_i) {
  const double m = std::clamp(1 - cos_i, 0.0, 1.0);
  const double m2 = m * m;
  return m2 * m2 * m;
}

/// The reflectance of a clear coat at normal incidence: of index 1.5.
inline constexpr double kCoatF0 = 0.04;

/// The reflectance at normal incidence.
inline double normal_reflectance(double eta) {
  const double r = (eta - 1) / (eta + 1);
  return r * r;
}

}  // namespace bandsaw
