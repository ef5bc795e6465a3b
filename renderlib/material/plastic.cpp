// The BSDF has two lobes: the reflection of the coat, smooth or rough, and the diffuse light, which
// passes through the coat twice.

#include "renderlib/material/plastic.h"

#include <algorithm>
#include <cmath>

#include "renderlib/base/check.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Returns the reflectance of the diffuse surface, divided by eta^2, including the light that the
/// coat reflects back to it. `internal` is the coat's internal reflectance.
Rgb with_internal(const Rgb& reflectance, double internal, bool nonlinear, double eta) {
  const auto channel = [&](float r) {
    const double back = nonlinear ? internal * r : internal;
    return static_cast<float>(r / ((1 - back) * eta * eta));
  };
  return {channel(reflectance.r), channel(reflectance.g), channel(reflectance.b)};
}

/// Returns true if wi is on the side of wo, by the geometric and by the shading normal.
bool leaves(const PlasticBsdf& bsdf, const Vec3& wi) {
  return dot(wi, bsdf.normal.geometric) > 0 && dot(wi, bsdf.normal.shading) > 0;
}

/// Returns the cosine between wi and the shading normal.
double cosine_of(const PlasticBsdf& bsdf, const Vec3& wi) {
  return std::min(1.0, dot(wi, bsdf.normal.shading));
}

/// Adds value and pdf of the reflection of a rough coat.
void add_coat(const PlasticBsdf& bsdf, const Vec3& wi, BsdfValue& sum) {
  const Basis frame = orthonormal_basis(bsdf.normal.shading);
  const Vec3 o = frame.to_local(bsdf.wo);
  const Vec3 i = frame.to_local(wi);
  const Vec3 half = o + i;
  const double size = length(half);
  if (!(size > 0)) {
    return;
  }
  const Vec3 h = half / size;
  const double pdf = facet_pdf_over_cos(o, h, *bsdf.facets) / 4;
  const double seen = facet_shadowing(o, i, *bsdf.facets) * facet_ratio(o, h, *bsdf.facets);
  const double reflected = fresnel(std::min(1.0, dot(o, h)), bsdf.eta);
  sum.value += bsdf.specular * static_cast<float>(reflected * pdf * seen);
  sum.pdf += bsdf.specular_chance * pdf;
}

}  // namespace

PlasticBsdf plastic_at(const Plastic& material, absl::Span<const Texture> textures,
                       const SurfacePoint& point, const SidedNormals& normal, const Vec3& wo) {
  BANDSAW_CHECK(material.coat != nullptr, "the materials of a scene are prepared");
  PlasticBsdf bsdf;
  bsdf.normal = {normal.geometric, facing_normal(normal.shading, normal.geometric, wo)};
  bsdf.wo = wo;
  bsdf.eta = material.index_of_refraction;
  bsdf.facets = facets_at(material.surface, textures, point);
  bsdf.coat = material.coat->at(bsdf.facets ? bsdf.facets->alpha_u : 0);
  bsdf.specular = material.specular;
  const Rgb reflectance = tinted(look_up(textures, material.reflectance, point), point.color);
  bsdf.diffuse =
      with_internal(reflectance, bsdf.coat.internal_reflectance(), material.nonlinear, bsdf.eta);
  bsdf.passing = bsdf.coat.passing(std::min(1.0, dot(wo, bsdf.normal.shading)));
  const double coat = (1 - bsdf.passing) * max_component(bsdf.specular);
  // `out` is the mean transmittance of the coat over all outgoing directions. The formula follows
  // from the reciprocity of the coat.
  const double out = (1 - bsdf.coat.internal_reflectance()) * bsdf.eta * bsdf.eta;
  const double below = bsdf.passing * out * max_component(bsdf.diffuse);
  bsdf.specular_chance = coat + below > 0 ? coat / (coat + below) : 0;
  return bsdf;
}

std::optional<BsdfSample> sample(const PlasticBsdf& bsdf, double u, double v, double lobe) {
  const Basis frame = orthonormal_basis(bsdf.normal.shading);
  const bool of_coat = lobe < bsdf.specular_chance;
  BsdfSample sample;
  if (of_coat && !bsdf.facets) {
    const bool usable = dot(mirrored(bsdf.wo, bsdf.normal.shading), bsdf.normal.geometric) > 0;
    const Vec3& n = usable ? bsdf.normal.shading : bsdf.normal.geometric;
    sample.wi = normalize(mirrored(bsdf.wo, n));
    sample.delta = true;
    sample.weight = bsdf.specular * static_cast<float>((1 - bsdf.passing) / bsdf.specular_chance);
    return sample;
  }
  Vec3 i;
  if (of_coat) {
    const Vec3 o = frame.to_local(bsdf.wo);
    i = mirrored(o, sample_facet(o, *bsdf.facets, u, v));
  } else {
    i = sample_cosine_hemisphere(u, v);
  }
  sample.wi = normalize(frame.to_world(i));
  const BsdfValue value = evaluate(bsdf, sample.wi);
  if (!(value.pdf > 0) || !std::isfinite(value.pdf)) {
    return std::nullopt;
  }
  sample.pdf = value.pdf;
  sample.weight = value.value * static_cast<float>(1 / value.pdf);
  return sample;
}

BsdfValue evaluate(const PlasticBsdf& bsdf, const Vec3& wi) {
  if (!leaves(bsdf, wi)) {
    return {};
  }
  BsdfValue sum;
  sum.value = diffuse_part(bsdf, wi);
  sum.pdf = (1 - bsdf.specular_chance) * cosine_hemisphere_pdf(cosine_of(bsdf, wi));
  if (bsdf.facets) {
    add_coat(bsdf, wi, sum);
  }
  return sum;
}

Rgb diffuse_part(const PlasticBsdf& bsdf, const Vec3& wi) {
  if (!leaves(bsdf, wi)) {
    return {};
  }
  const double cos_i = cosine_of(bsdf, wi);
  return bsdf.diffuse *
         static_cast<float>(cosine_hemisphere_pdf(cos_i) * bsdf.passing * bsdf.coat.passing(cos_i));
}

}  // namespace bandsaw
