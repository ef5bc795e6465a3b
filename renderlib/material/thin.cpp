// Two thin sheets: a smooth pane, which reflects or passes light without deflection, and a sheet
// that reflects and transmits diffusely.

#include "renderlib/material/thin.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Returns the probability with which the first of two lobes is sampled. The probabilities of both
/// lobes are in proportion to their brightest channels.
double chance_of(const Rgb& first, const Rgb& second) {
  const double a = max_component(first);
  const double sum = a + double{max_component(second)};
  return sum > 0 ? a / sum : 0;
}

}  // namespace

ThinDielectricBsdf thin_dielectric(const ThinDielectric& pane, const SidedNormals& normal,
                                   const Vec3& wo) {
  const double face = fresnel(std::min(1.0, dot(wo, normal.shading)), pane.index_of_refraction);
  // The share of light that the pane reflects, with all reflections between its two faces (thin.h).
  const double both = 2 * face / (1 + face);
  ThinDielectricBsdf bsdf{normal, wo, pane.specular * static_cast<float>(both),
                          pane.transmission * static_cast<float>(1 - both)};
  bsdf.reflection = chance_of(bsdf.reflected, bsdf.transmitted);
  bsdf.free_passage = pane.free_passage;
  return bsdf;
}

std::optional<BsdfSample> sample(const ThinDielectricBsdf& bsdf, double lobe) {
  BsdfSample sample;
  sample.delta = true;
  if (lobe < bsdf.reflection) {
    sample.wi = normalize(mirrored(bsdf.wo, bsdf.normal.shading));
    sample.weight = bsdf.reflected * static_cast<float>(1 / bsdf.reflection);
    return sample;
  }
  if (is_black(bsdf.transmitted)) {
    return std::nullopt;
  }
  sample.wi = -bsdf.wo;
  sample.counts = !bsdf.free_passage;
  sample.weight = bsdf.transmitted * static_cast<float>(1 / (1 - bsdf.reflection));
  return sample;
}

DiffuseTransmissionBsdf diffuse_transmission(const SidedNormals& normal, const Rgb& reflectance,
                                             const Rgb& transmittance) {
  const auto fit = [](float one, float other) { return one / std::max(1.0f, one + other); };
  const Rgb& r = reflectance;
  const Rgb& t = transmittance;
  DiffuseTransmissionBsdf bsdf{normal,
                               {fit(r.r, t.r), fit(r.g, t.g), fit(r.b, t.b)},
                               {fit(t.r, r.r), fit(t.g, r.g), fit(t.b, r.b)}};
  bsdf.reflection = chance_of(bsdf.reflectance, bsdf.transmittance);
  return bsdf;
}

std::optional<BsdfSample> sample(const DiffuseTransmissionBsdf& bsdf, double u, double v,
                                 double lobe) {
  const Vec3 local = sample_cosine_hemisphere(u, v);
  const Vec3 above = orthonormal_basis(bsdf.normal.shading).to_world(local);
  const bool reflects = lobe < bsdf.reflection;
  BsdfSample sample;
  sample.wi = reflects ? above : -above;
  const BsdfValue value = evaluate(bsdf, sample.wi);
  if (!(value.pdf > 0)) {
    return std::nullopt;
  }
  sample.pdf = value.pdf;
  sample.weight = reflects ? bsdf.reflectance * static_cast<float>(1 / bsdf.reflection)
                           : bsdf.transmittance * static_cast<float>(1 / (1 - bsdf.reflection));
  return sample;
}

BsdfValue evaluate(const DiffuseTransmissionBsdf& bsdf, const Vec3& wi) {
  const double side = dot(wi, bsdf.normal.geometric);
  const double cos_i = dot(wi, bsdf.normal.shading);
  if (!(side * cos_i > 0)) {
    return {};
  }
  const double pdf = cosine_hemisphere_pdf(std::abs(cos_i));
  const bool reflects = side > 0;
  return {(reflects ? bsdf.reflectance : bsdf.transmittance) * static_cast<float>(pdf),
          (reflects ? bsdf.reflection : 1 - bsdf.reflection) * pdf};
}

}  // namespace bandsaw
