#pragma once

// Rough metals: microfacets that reflect by the Fresnel equations of a conductor (Walter et al.
// 2007, eq. 20), with single scattering.

#include <optional>

#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/material.h"
#include "renderlib/material/microfacets.h"
#include "renderlib/math/rgb.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {

struct RoughConductorBsdf {
  Vec3 geometric;  ///< geometric normal on the side of wo
  /// z is the shading normal, dot(wo, z) > 0. If the facets are anisotropic, x lies along the uv
  /// coordinate u (facet_frame() in shading_normal.h).
  Basis frame;
  Vec3 wo;
  Facets facets;
  std::optional<ConductorIndex> index;  ///< without it, all light is reflected
  Rgb specular;                         ///< factor of the reflection
};

/// Returns the reflectance of a facet; white without an index. cos_i, in [0, 1], is the cosine of
/// the angle between the incident light and the facet's normal, which equals the angle of the
/// reflected light.
Rgb conductor_reflectance(const std::optional<ConductorIndex>& index, double cos_i);

/// sample() and evaluate() are those of material/bsdf.h for this kind. u and v select the facet.
/// Returns std::nullopt if the light is lost between facets.
std::optional<BsdfSample> sample(const RoughConductorBsdf& bsdf, double u, double v);
BsdfValue evaluate(const RoughConductorBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
