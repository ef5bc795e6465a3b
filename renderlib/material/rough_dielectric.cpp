// Glass with microfacets: a facet visible from wo is sampled. Then the Fresnel term decides whether
// the facet reflects or refracts the direction. In the frame, o is wo, i is wi, and h is the normal
// of the facet.

#include "renderlib/material/rough_dielectric.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"

namespace bandsaw {
namespace {

/// Returns true if the geometric normal and the shading normal agree on which side of the surface
/// wi is. `local_z` is the z of wi in the shading frame.
bool is_consistent(const RoughDielectricBsdf& bsdf, const Vec3& wi, double local_z) {
  return dot(wi, bsdf.geometric) * local_z > 0;
}

}  // namespace

std::optional<BsdfSample> sample(const RoughDielectricBsdf& bsdf, double u, double v, double lobe) {
  const Basis& frame = bsdf.frame;
  const Vec3 o = frame.to_local(bsdf.wo);
  const Vec3 h = sample_facet(o, bsdf.facets, u, v);
  const double o_h = std::min(1.0, dot(o, h));
  if (o_h <= 0) {
    return std::nullopt;
  }
  const double visible = facet_pdf_over_cos(o, h, bsdf.facets);
  const double reflected_share = fresnel(o_h, bsdf.eta);
  BsdfSample sample;
  Vec3 i;
  if (lobe < reflected_share) {
    i = mirrored(o, h);
    if (i.z <= 0) {
      return std::nullopt;
    }
    sample.pdf = reflected_share * visible / 4;
  } else {
    const std::optional<double> cos_t = refracted_cos(o_h, bsdf.eta);
    if (!cos_t) {
      return std::nullopt;
    }
    i = refracted(o, h, *cos_t, bsdf.eta);
    if (i.z >= 0) {
      return std::nullopt;
    }
    sample.pdf = (1 - reflected_share) * visible * refraction_jacobian(o_h, dot(i, h), bsdf.eta);
    sample.compression = 1 / (bsdf.eta * bsdf.eta);
  }
  i = normalize(i);
  sample.wi = normalize(frame.to_world(i));
  const double seen = facet_shadowing(o, i, bsdf.facets) * facet_ratio(o, h, bsdf.facets);
  sample.weight = gray(static_cast<float>(seen * sample.compression));
  if (!is_consistent(bsdf, sample.wi, i.z) || !(sample.pdf > 0) || !std::isfinite(sample.pdf)) {
    return std::nullopt;
  }
  return sample;
}

BsdfValue evaluate(const RoughDielectricBsdf& bsdf, const Vec3& wi) {
  const Vec3 o = bsdf.frame.to_local(bsdf.wo);
  const Vec3 i = bsdf.frame.to_local(wi);
  if (!is_consistent(bsdf, wi, i.z)) {
    return {};
  }
  const bool reflects = i.z > 0;
  // For a refraction, the half vector -(o + eta i) points to the side of smaller index (Walter et
  // al. 2007, eq. 16). The division by copysign(size, h.z) turns it to the side of the normal.
  Vec3 h = reflects ? o + i : -(o + i * bsdf.eta);
  const double size = length(h);
  if (!(size > 0)) {
    return {};
  }
  h = h / std::copysign(size, h.z);
  const double o_h = std::min(1.0, dot(o, h));
  const double i_h = dot(i, h);
  if (o_h <= 0 || i_h * i.z <= 0) {
    return {};
  }
  const double reflected_share = fresnel(o_h, bsdf.eta);
  const double visible = facet_pdf_over_cos(o, h, bsdf.facets);
  const double seen = facet_shadowing(o, i, bsdf.facets) * facet_ratio(o, h, bsdf.facets);
  BsdfValue value;
  double compression = 1;
  if (reflects) {
    value.pdf = reflected_share * visible / 4;
  } else {
    value.pdf = (1 - reflected_share) * visible * refraction_jacobian(o_h, i_h, bsdf.eta);
    compression = 1 / (bsdf.eta * bsdf.eta);
  }
  value.value = gray(static_cast<float>(value.pdf * seen * compression));
  return value;
}

}  // namespace bandsaw
