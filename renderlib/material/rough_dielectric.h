#pragma once

// Rough glass: microfacets that reflect and refract by the exact Fresnel equations (Walter et al.
// 2007, eqs. 20 and 21), with single scattering.

#include <optional>

#include "renderlib/material/bsdf_sample.h"
#include "renderlib/material/microfacets.h"
#include "renderlib/sampling/basis.h"

namespace bandsaw {

struct RoughDielectricBsdf {
  Vec3 geometric;  ///< geometric normal on the side of wo
  /// z is the shading normal, dot(wo, z) > 0. If the facets are anisotropic, x lies along the uv
  /// coordinate u (facet_frame() in shading_normal.h).
  Basis frame;
  Vec3 wo;
  double eta = 1;  ///< index beyond the surface over index on this side; not 1
  Facets facets;
};

/// sample() and evaluate() are those of material/bsdf.h for this kind. u and v select the
/// microfacet, and `lobe` selects reflection or refraction. Returns std::nullopt if the light is
/// lost between microfacets.
std::optional<BsdfSample> sample(const RoughDielectricBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const RoughDielectricBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
