#pragma once

// Rough glass: GGX microfacets that reflect and refract by the exact Fresnel equations (Walter et
// al. 2007, eqs. 20 and 21), with single scattering.

#include <optional>

#include "renderlib/material/bsdf_sample.h"

namespace bandsaw {

struct RoughDielectricBsdf {
  SidedNormals normal;  ///< dot(wo, shading) > 0
  Vec3 wo;
  double eta = 1;  ///< index beyond the surface over index on this side; not 1
  double alpha = 1;
};

/// u and v select the microfacet, `lobe` reflection or refraction. Returns std::nullopt if the
/// light is lost between microfacets.
std::optional<BsdfSample> sample(const RoughDielectricBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const RoughDielectricBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
