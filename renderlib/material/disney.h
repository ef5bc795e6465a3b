#pragma once

// The parts that the two principled BSDFs share (principled_bsdf.h, thin_principled_bsdf.h):
// diffuse light with retro-reflection, flatness and sheen, and Schlick's Fresnel reflectance with a
// tint (Burley 2012, "Physically Based Shading at Disney"; 2015, "Extending the Disney BRDF to a
// BSDF"). The constants are those of Mitsuba 3.

#include <algorithm>
#include <cmath>

#include "absl/types/span.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/material.h"
#include "renderlib/material/microfacets.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Returns the value of a textured number at the point.
inline double number_at(const Number& number, absl::Span<const Texture> textures,
                        const SurfacePoint& point) {
  return mapped_number(textures, number.value, number.map, point);
}

/// Returns the facets for a roughness and an anisotropy (Burley 2012, section 5.4). Every surface
/// is rough: alpha is at least 0.001.
inline Facets principled_facets(double roughness, double anisotropic) {
  constexpr double kLeast = 1e-3;
  const double alpha = roughness * roughness;
  const double aspect = std::sqrt(1 - 0.9 * anisotropic);
  return {std::max(kLeast, alpha / aspect), std::max(kLeast, alpha * aspect),
          Microfacets::Distribution::kGgx, Microfacets::Masking::kSeparable};
}

/// Returns a colour of luminance 1 with the hue of `base`; white if `base` is black.
inline Rgb hue_of(const Rgb& base) {
  const float bright = luminance(base);
  return bright > 0 ? base * (1 / bright) : gray(1);
}

/// Returns f0 + (1 - f0) (1 - cos)^5.
inline Rgb schlick(const Rgb& f0, double cos_i) {
  const auto rim = static_cast<float>(schlick_rim(cos_i));
  return f0 * (1 - rim) + gray(rim);
}

/// Parameters of the diffuse light of the principled BSDFs.
struct DisneyDiffuse {
  Rgb base;
  double roughness = 0.5;
  double flatness = 0;  ///< weight of the approximation of subsurface scattering, [0, 1]
  Rgb sheen;            ///< the weight of the sheen times its colour
};

/// Returns the value of the diffuse light, cosine included; `diffuse` is the weight of everything
/// except the sheen. o and i are the directions in the frame of the surface, both with z > 0; h is
/// their half vector.
inline Rgb disney_diffuse(const DisneyDiffuse& d, double diffuse, const Vec3& o, const Vec3& i,
                          const Vec3& h) {
  const double rim_o = schlick_rim(o.z);
  const double rim_i = schlick_rim(i.z);
  const double cos_d = dot(h, i);
  const double retro = 2 * d.roughness * cos_d * cos_d;
  double factor =
      (1 - 0.5 * rim_i) * (1 - 0.5 * rim_o) + retro * (rim_o + rim_i + rim_o * rim_i * (retro - 1));
  if (d.flatness > 0) {
    // Burley's approximation of subsurface scattering, after Hanrahan and Krueger 1993.
    const auto toward = [&](double rim) { return 1 + (0.5 * retro - 1) * rim; };
    const double flat = toward(rim_o) * toward(rim_i);
    const double below = 1.25 * (flat * (1 / (o.z + i.z) - 0.5) + 0.5);
    factor += (below - factor) * d.flatness;
  }
  return d.base * static_cast<float>(diffuse * factor * i.z * kInvPi) +
         d.sheen * static_cast<float>(schlick_rim(std::abs(cos_d)) * i.z);
}

}  // namespace bandsaw
