#pragma once

// The GGX microfacet distribution with height-correlated Smith masking-shadowing (Walter et al.
// 2007, "Microfacet Models for Refraction through Rough Surfaces"; Heitz 2014, "Understanding the
// Masking-Shadowing Function", JCGT 3(2), section 6.3). All vectors are in the local frame of the
// surface, in which z is the normal. Directions are unit vectors with z > 0. alpha is the width of
// the distribution, in [kMinAlpha, 1]. microfacets.h has anisotropic facets and Beckmann's
// distribution.

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// Minimum alpha. A smaller alpha is raised to this minimum, or counts as smooth where the material
/// says so. The minimum spreads light by a hundredth of a degree.
inline constexpr double kMinAlpha = 1e-4;

/// Returns the density D(h) of facet normals. It is computed from x and y, which are precise where
/// z is nearly 1, so nothing cancels for small alpha.
inline double ggx_distribution(const Vec3& h, double alpha) {
  const double t = (h.x * h.x + h.y * h.y) / (alpha * alpha) + h.z * h.z;
  return 1 / (kPi * alpha * alpha * t * t);
}

/// Returns the length of w with x and y multiplied by alpha. With this length s and z = |w.z|,
/// G1(w) is 2 z / (z + s).
inline double ggx_stretched(const Vec3& w, double alpha) {
  return std::sqrt(alpha * alpha * (w.x * w.x + w.y * w.y) + w.z * w.z);
}

/// Returns G1(o), the share of microfacets visible from `o`.
inline double ggx_masking(const Vec3& o, double alpha) {
  const double z = std::abs(o.z);
  return z > 0 ? 2 * z / (z + ggx_stretched(o, alpha)) : 0;
}

/// Returns G2(o, i) / G1(o), in [0, 1]: among the microfacets visible from o, the share visible
/// from i as well. For transmission i.z is negative.
inline double ggx_shadowing(const Vec3& o, const Vec3& i, double alpha) {
  const double zo = std::abs(o.z);
  const double zi = std::abs(i.z);
  const double so = ggx_stretched(o, alpha);
  const double below = zo * ggx_stretched(i, alpha) + zi * so;
  return below > 0 ? zi * (zo + so) / below : 0;
}

/// Returns the pdf of visible normals h as seen from o, divided by |dot(o, h)|. The quotient is
/// finite at grazing angles.
inline double ggx_visible_over_cos(const Vec3& o, const Vec3& h, double alpha) {
  return 2 * ggx_distribution(h, alpha) / (std::abs(o.z) + ggx_stretched(o, alpha));
}

/// Samples a visible normal with pdf ggx_visible_over_cos(o, h) dot(o, h); u, v in [0, 1). Dupuy
/// and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", listing 3.
inline Vec3 sample_ggx_visible(const Vec3& o, double alpha, double u, double v) {
  const Vec3 stretched = normalize({alpha * o.x, alpha * o.y, o.z});
  const SinCos phi = sincos_turns(u);
  const double z = (1 - v) * (1 + stretched.z) - stretched.z;
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const Vec3 h = Vec3{r * phi.cos, r * phi.sin, z} + stretched;
  const Vec3 facet{alpha * h.x, alpha * h.y, std::max(h.z, 1e-300)};
  return normalize(facet);
}

}  // namespace bandsaw
