// A metal with microfacets: a facet visible from wo is sampled and reflects the direction. The
// Fresnel term is computed from eta and k. In the frame, o is wo, i is wi, and h is the normal of
// the facet.

#include "renderlib/material/conductor.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"

namespace bandsaw {

Rgb conductor_reflectance(const std::optional<ConductorIndex>& index, double cos_i) {
  if (!index) {
    return {1, 1, 1};
  }
  const auto channel = [&](float eta, float k) {
    return static_cast<float>(conductor_fresnel(cos_i, double{eta}, double{k}));
  };
  const auto& [eta, k] = *index;
  return {channel(eta.r, k.r), channel(eta.g, k.g), channel(eta.b, k.b)};
}

std::optional<BsdfSample> sample(const RoughConductorBsdf& bsdf, double u, double v) {
  const Vec3 o = bsdf.frame.to_local(bsdf.wo);
  const Vec3 h = sample_facet(o, bsdf.facets, u, v);
  const double o_h = std::min(1.0, dot(o, h));
  const Vec3 i = mirrored(o, h);
  if (o_h <= 0 || i.z <= 0) {
    return std::nullopt;
  }
  BsdfSample sample;
  sample.wi = normalize(bsdf.frame.to_world(i));
  sample.pdf = facet_pdf_over_cos(o, h, bsdf.facets) / 4;
  const double seen = facet_shadowing(o, i, bsdf.facets) * facet_ratio(o, h, bsdf.facets);
  sample.weight = conductor_reflectance(bsdf.index, o_h) * bsdf.specular * static_cast<float>(seen);
  if (dot(sample.wi, bsdf.geometric) <= 0 || !(sample.pdf > 0) || !std::isfinite(sample.pdf)) {
    return std::nullopt;
  }
  return sample;
}

BsdfValue evaluate(const RoughConductorBsdf& bsdf, const Vec3& wi) {
  const Vec3 o = bsdf.frame.to_local(bsdf.wo);
  const Vec3 i = bsdf.frame.to_local(wi);
  const Vec3 sum = o + i;
  const double size = length(sum);
  if (dot(wi, bsdf.geometric) <= 0 || i.z <= 0 || !(size > 0)) {
    return {};
  }
  const Vec3 h = sum / size;
  const double o_h = std::min(1.0, dot(o, h));
  BsdfValue value;
  value.pdf = facet_pdf_over_cos(o, h, bsdf.facets) / 4;
  const double seen = facet_shadowing(o, i, bsdf.facets) * facet_ratio(o, h, bsdf.facets);
  value.value =
      conductor_reflectance(bsdf.index, o_h) * bsdf.specular * static_cast<float>(value.pdf * seen);
  return value;
}

}  // namespace bandsaw
