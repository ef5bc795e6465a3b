#pragma once

// Rough clear glass: GGX facets that reflect and refract by the exact Fresnel equations (Walter et
// al. 2007, eqs. 20 and 21), one scattering at the surface.

#include <optional>

#include "renderlib/material/bsdf_sample.h"

namespace bandsaw {

struct RoughDielectricBsdf {
  SidedNormals normal;  ///< dot(wo, shading) > 0
  Vec3 wo;
  double eta = 1;  ///< index on the other side over index on this side; not 1
  double alpha = 1;
};

/// u, v choose the facet, lobe reflection or refraction. Nothing: lost between facets.
std::optional<BsdfSample> sample(const RoughDielectricBsdf& bsdf, double u, double v, double lobe);
BsdfValue evaluate(const RoughDielectricBsdf& bsdf, const Vec3& wi);

}  // namespace bandsaw
