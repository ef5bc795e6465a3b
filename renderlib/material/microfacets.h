#pragma once

// Microfacet distributions at a point: GGX (Walter et al. 2007) and Beckmann (Beckmann and
// Spizzichino 1963), isotropic or not. Directions are unit vectors in the local frame of the
// surface, with z > 0. In this frame, z is the normal, and x lies along the uv coordinate u. For
// both distributions, facet normals are sampled from the visible normals of GGX. Let a be the angle
// of a facet normal to z, and t = (tan a / alpha)^2. Then Beckmann's density divided by GGX's is
// exp(-t) (1 + t)^2, which is at most 4 / e. So the weights of samples stay bounded, and no error
// function is needed.

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/ggx.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// The facets at a point: class Microfacets (material/material.h) with its maps looked up.
struct Facets {
  double alpha_u = 1;  ///< >= kMinAlpha
  double alpha_v = 1;
  Microfacets::Distribution distribution = Microfacets::Distribution::kGgx;
  Microfacets::Masking masking = Microfacets::Masking::kSeparable;

  bool isotropic() const { return alpha_u == alpha_v; }
};

/// Returns the facets of `surface` at the point; std::nullopt where it is smooth.
inline std::optional<Facets> facets_at(const Microfacets& surface,
                                       absl::Span<const Texture> textures,
                                       const SurfacePoint& point) {
  const double u = mapped_number(textures, surface.alpha_u, surface.alpha_u_map, point);
  const double v = surface.isotropic()
                       ? u
                       : mapped_number(textures, surface.alpha_v, surface.alpha_v_map, point);
  if (u < kMinAlpha && v < kMinAlpha) {
    return std::nullopt;
  }
  return Facets{std::max(kMinAlpha, u), std::max(kMinAlpha, v), surface.distribution,
                surface.masking};
}

/// Returns (alpha_u x)^2 + (alpha_v y)^2 for w = (x, y, z). If both alphas are equal, this is
/// (alpha z tan a)^2, where a is the angle of w to z.
inline double facet_slope2(const Vec3& w, const Facets& f) {
  const double x = f.alpha_u * w.x;
  const double y = f.alpha_v * w.y;
  return x * x + y * y;
}

/// Returns the length of w with x multiplied by alpha_u and y by alpha_v, as ggx_stretched() does
/// with one alpha.
inline double facet_stretched(const Vec3& w, const Facets& f) {
  return f.isotropic() ? ggx_stretched(w, f.alpha_u) : std::sqrt(facet_slope2(w, f) + w.z * w.z);
}

/// Returns G1(w): the share of facets that is visible from w; for Beckmann by the rational
/// approximation of Walter et al. 2007, section 5.2.
inline double facet_masking(const Vec3& w, const Facets& f) {
  const double z = std::abs(w.z);
  if (!(z > 0)) {
    return 0;
  }
  if (f.distribution == Microfacets::Distribution::kGgx) {
    return 2 * z / (z + facet_stretched(w, f));
  }
  const double slope = std::sqrt(facet_slope2(w, f));
  if (z >= 1.6 * slope) {
    return 1;
  }
  const double a = z / slope;
  return (3.535 * a + 2.181 * a * a) / (1 + 2.276 * a + 2.577 * a * a);
}

/// Returns G2(o, i) / G1(o): among the facets visible from o, the share visible from i as well. For
/// transmission i.z is negative.
inline double facet_shadowing(const Vec3& o, const Vec3& i, const Facets& f) {
  if (f.masking == Microfacets::Masking::kSeparable) {
    return facet_masking(i, f);
  }
  if (f.distribution == Microfacets::Distribution::kGgx && f.isotropic()) {
    return ggx_shadowing(o, i, f.alpha_u);
  }
  const double mo = facet_masking(o, f);
  const double mi = facet_masking(i, f);
  return mi > 0 ? mi / (mi + mo * (1 - mi)) : 0;
}

/// Returns the pdf of sample_facet(), divided by |dot(o, h)|.
inline double facet_pdf_over_cos(const Vec3& o, const Vec3& h, const Facets& f) {
  if (f.isotropic()) {
    return ggx_visible_over_cos(o, h, f.alpha_u);
  }
  const double x = h.x / f.alpha_u;
  const double y = h.y / f.alpha_v;
  const double t = x * x + y * y + h.z * h.z;
  const double density = 1 / (kPi * f.alpha_u * f.alpha_v * t * t);
  return 2 * density / (std::abs(o.z) + facet_stretched(o, f));
}

/// Returns D(h) G1(o) of the distribution, divided by D(h) G1(o) of GGX. It corrects for
/// sample_facet(), which always samples from GGX. For GGX it is 1.
inline double facet_ratio(const Vec3& o, const Vec3& h, const Facets& f) {
  if (f.distribution == Microfacets::Distribution::kGgx) {
    return 1;
  }
  const double x = h.x / f.alpha_u;
  const double y = h.y / f.alpha_v;
  const double t = (x * x + y * y) / (h.z * h.z);
  constexpr double kNone = 700;  // exp(-t) is 0 up to rounding
  if (!(t < kNone)) {
    return 0;
  }
  const double z = std::abs(o.z);
  const double of_ggx = 2 * z / (z + facet_stretched(o, f));
  return of_ggx > 0 ? exp(-t) * (1 + t) * (1 + t) * facet_masking(o, f) / of_ggx : 0;
}

/// Samples the normal of a facet visible from o; u, v in [0, 1) (Dupuy and Benyoub 2023, "Sampling
/// Visible GGX Normals with Spherical Caps", listing 3).
inline Vec3 sample_facet(const Vec3& o, const Facets& f, double u, double v) {
  if (f.isotropic()) {
    return sample_ggx_visible(o, f.alpha_u, u, v);
  }
  const Vec3 stretched = normalize({f.alpha_u * o.x, f.alpha_v * o.y, o.z});
  const SinCos phi = sincos_turns(u);
  const double z = (1 - v) * (1 + stretched.z) - stretched.z;
  const double r = std::sqrt(std::max(0.0, 1 - z * z));
  const Vec3 h = Vec3{r * phi.cos, r * phi.sin, z} + stretched;
  return normalize({f.alpha_u * h.x, f.alpha_v * h.y, std::max(h.z, 1e-300)});
}

}  // namespace bandsaw
