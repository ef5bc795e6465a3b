// The BSDF has three groups of lobes: specular (reflection or refraction), diffuse and clear coat.
// sample() chooses one; evaluate() adds up value and pdf of all. The numbers of the formulas are
// those of Mitsuba 3, after Burley 2012, "Physically Based Shading at Disney".

#include "renderlib/material/principled_bsdf.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/shading_normal.h"
#include "renderlib/math/elementary.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

enum Lobe : std::size_t { kSpecular, kDiffuse, kCoat };

/// Returns the coat's distribution of normals: generalised Trowbridge and Reitz with exponent 1
/// (Burley 2012, appendix B.2), for alpha in (0, 1).
double gtr1(double cos_theta, double alpha) {
  const double a2 = alpha * alpha;
  return (a2 - 1) / (kPi * log(a2) * (1 + (a2 - 1) * cos_theta * cos_theta));
}

/// Samples a facet normal with the pdf gtr1() times its cosine.
Vec3 sample_gtr1(double alpha, double u, double v) {
  const double a2 = alpha * alpha;
  const double cos2 = (1 - exp((1 - v) * log(a2))) / (1 - a2);
  const double r = std::sqrt(std::clamp(1 - cos2, 0.0, 1.0));
  const SinCos phi = sincos_turns(u);
  return {r * phi.cos, r * phi.sin, std::sqrt(std::clamp(cos2, 0.0, 1.0))};
}

/// Returns the probability with which the specular lobe reflects at a facet of dielectric
/// reflectance `f`; otherwise it refracts.
double reflecting(const PrincipledBsdf& bsdf, double f) {
  return bsdf.inside ? f : 1 - bsdf.refracting * (1 - f);
}

/// Returns the reflectance of the specular lobe at a facet of dielectric reflectance `f`; o_h is
/// the cosine between wo and the facet's normal.
Rgb specular_reflectance(const PrincipledBsdf& bsdf, double f, double o_h) {
  if (bsdf.inside) {
    return gray(static_cast<float>(bsdf.refracting * f));
  }
  const double dielectric = 1 - bsdf.metallic;
  const Rgb f0 = hue_of(bsdf.diffuse.base) * static_cast<float>(normal_reflectance(bsdf.eta));
  return gray(static_cast<float>(dielectric * (1 - bsdf.spec_tint) * f)) +
         schlick(bsdf.diffuse.base, o_h) * static_cast<float>(bsdf.metallic) +
         schlick(f0, o_h) * static_cast<float>(dielectric * bsdf.spec_tint);
}

/// The functions add_...() add value and pdf of a lobe to `sum`. i is wi in the frame, h the half
/// vector of wo and wi.
void add_specular(const PrincipledBsdf& bsdf, const Vec3& i, const Vec3& h, BsdfValue& sum) {
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  const double f = fresnel(o_h, bsdf.eta);
  const double pdf = facet_pdf_over_cos(bsdf.o, h, bsdf.facets) / 4;
  const double seen = pdf * facet_shadowing(bsdf.o, i, bsdf.facets);
  sum.value += specular_reflectance(bsdf, f, o_h) * static_cast<float>(seen);
  sum.pdf += bsdf.chances[kSpecular] * reflecting(bsdf, f) * pdf;
}

/// Adds the value and the pdf of the clear coat to `sum`. h is the half vector of wo and wi.
void add_coat(const PrincipledBsdf& bsdf, const Vec3& i, const Vec3& h, BsdfValue& sum) {
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  const double density = gtr1(h.z, bsdf.coat_alpha);
  const double reflected = kCoatF0 + (1 - kCoatF0) * schlick_rim(o_h);
  constexpr double kMaskingAlpha = 0.25;
  const double masking = ggx_masking(bsdf.o, kMaskingAlpha) * ggx_masking(i, kMaskingAlpha);
  sum.value +=
      gray(static_cast<float>(0.25 * bsdf.clearcoat * reflected * density * masking * i.z));
  sum.pdf += bsdf.chances[kCoat] * density * h.z / (4 * o_h);
}

/// Adds the value and the pdf of rough refraction to `sum`. Adds nothing if no facet refracts wo to
/// i, which is wi in the local frame.
void add_refraction(const PrincipledBsdf& bsdf, const Vec3& i, BsdfValue& sum) {
  // The half vector of a refraction (Walter et al. 2007, eq. 16). The division below by
  // copysign(size, h.z) turns the half vector to the side of the normal.
  Vec3 h = -(bsdf.o + i * bsdf.eta);
  const double size = length(h);
  if (!(size > 0)) {
    return;
  }
  h = h / std::copysign(size, h.z);
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  const double i_h = dot(i, h);
  if (o_h <= 0 || i_h >= 0) {
    return;
  }
  const double f = fresnel(o_h, bsdf.eta);
  const double pdf = (1 - f) * facet_pdf_over_cos(bsdf.o, h, bsdf.facets) *
                     refraction_jacobian(o_h, i_h, bsdf.eta);
  const double seen =
      bsdf.refracting * pdf * facet_shadowing(bsdf.o, i, bsdf.facets) / (bsdf.eta * bsdf.eta);
  const Rgb& base = bsdf.diffuse.base;
  sum.value +=
      Rgb{std::sqrt(base.r), std::sqrt(base.g), std::sqrt(base.b)} * static_cast<float>(seen);
  // The probability of refraction, 1 - reflecting(), is refracting (1 - f) outside and 1 - f
  // inside. `pdf` has the factor 1 - f already.
  sum.pdf += bsdf.chances[kSpecular] * (bsdf.inside ? 1 : bsdf.refracting) * pdf;
}

/// Sets the selection probabilities in proportion to rough estimates of the lobes' albedos. The
/// estimates of the specular lobes, and of a diffuse lobe that is present, are at least 0.1
/// (kMinAlbedo), so that these lobes are not sampled too rarely.
void choose_chances(PrincipledBsdf& bsdf) {
  if (bsdf.inside) {
    bsdf.chances = {bsdf.refracting > 0 ? 1.0 : 0.0, 0, 0};
    return;
  }
  constexpr double kMinAlbedo = 0.1;
  const double f = fresnel(std::min(1.0, bsdf.o.z), bsdf.eta);
  const double base = max_component(bsdf.diffuse.base);
  const double dielectric = f * (1 - bsdf.metallic) + bsdf.refracting * (1 - f);
  const double matte = bsdf.matte * base + 0.25 * double{max_component(bsdf.diffuse.sheen)};
  bsdf.chances[kSpecular] = std::max(kMinAlbedo, dielectric + bsdf.metallic * base);
  bsdf.chances[kDiffuse] = matte > 0 ? std::max(kMinAlbedo, matte) : 0;
  bsdf.chances[kCoat] = 0.25 * bsdf.clearcoat;
  const double sum = bsdf.chances[kSpecular] + bsdf.chances[kDiffuse] + bsdf.chances[kCoat];
  for (double& chance : bsdf.chances) {
    chance /= sum;
  }
}

/// Returns the direction of the specular lobe, in the frame; `choice` in [0, 1) selects reflection
/// or refraction. Sets `compression` for a refraction.
std::optional<Vec3> sample_specular(const PrincipledBsdf& bsdf, double u, double v, double choice,
                                    double& compression) {
  const Vec3 h = sample_facet(bsdf.o, bsdf.facets, u, v);
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  if (o_h <= 0) {
    return std::nullopt;
  }
  if (choice < reflecting(bsdf, fresnel(o_h, bsdf.eta))) {
    const Vec3 i = mirrored(bsdf.o, h);
    return i.z > 0 ? std::optional(i) : std::nullopt;
  }
  const std::optional<double> cos_t = refracted_cos(o_h, bsdf.eta);
  if (!cos_t) {
    return std::nullopt;
  }
  const Vec3 i = refracted(bsdf.o, h, *cos_t, bsdf.eta);
  compression = 1 / (bsdf.eta * bsdf.eta);
  return i.z < 0 ? std::optional(i) : std::nullopt;
}

}  // namespace

PrincipledBsdf principled_at(const Principled& material, absl::Span<const Texture> textures,
                             const SurfacePoint& point, const SidedNormals& normal, bool outside,
                             const Vec3& wo) {
  const auto number = [&](const Number& n) { return number_at(n, textures, point); };
  PrincipledBsdf bsdf;
  bsdf.geometric = normal.geometric;
  const double anisotropic = number(material.anisotropic);
  const double roughness = number(material.roughness);
  bsdf.facets = principled_facets(roughness, anisotropic);
  bsdf.frame = facet_frame(point, facing_normal(normal.shading, normal.geometric, wo),
                           bsdf.facets.isotropic());
  bsdf.o = bsdf.frame.to_local(wo);
  const bool solid = material.spec_trans.value > 0;
  // An index of 1 would not refract, so that rough facets would have no pdf.
  const double index =
      solid ? std::max(1.001, material.index_of_refraction) : material.index_of_refraction;
  bsdf.inside = solid && !outside;
  bsdf.eta = bsdf.inside ? 1 / index : index;
  const Rgb base = tinted(look_up(textures, material.base_color, point), point.color);
  bsdf.metallic = number(material.metallic);
  const double spec_trans = number(material.spec_trans);
  bsdf.refracting = (1 - bsdf.metallic) * spec_trans;
  bsdf.matte = (1 - bsdf.metallic) * (1 - spec_trans);
  bsdf.spec_tint = number(material.spec_tint);
  const auto sheen = static_cast<float>(number(material.sheen) * (1 - bsdf.metallic));
  const auto sheen_tint = static_cast<float>(number(material.sheen_tint));
  bsdf.diffuse = {base, roughness, number(material.flatness),
                  lerp(gray(1), hue_of(base), sheen_tint) * sheen};
  bsdf.clearcoat = number(material.clearcoat);
  bsdf.coat_alpha = 0.1 + (0.001 - 0.1) * number(material.clearcoat_gloss);
  choose_chances(bsdf);
  return bsdf;
}

std::optional<BsdfSample> sample(const PrincipledBsdf& bsdf, double u, double v, double lobe) {
  BsdfSample sample;
  std::optional<Vec3> i;
  const double specular = bsdf.chances[kSpecular];
  if (lobe < specular) {
    i = sample_specular(bsdf, u, v, lobe / specular, sample.compression);
  } else if (lobe < specular + bsdf.chances[kDiffuse]) {
    i = sample_cosine_hemisphere(u, v);
  } else if (bsdf.chances[kCoat] > 0) {
    i = mirrored(bsdf.o, sample_gtr1(bsdf.coat_alpha, u, v));
    i = i->z > 0 ? i : std::nullopt;
  }
  if (!i) {
    return std::nullopt;
  }
  sample.wi = normalize(bsdf.frame.to_world(*i));
  const BsdfValue value = evaluate(bsdf, sample.wi);
  if (!(value.pdf > 0) || !std::isfinite(value.pdf)) {
    return std::nullopt;
  }
  sample.pdf = value.pdf;
  sample.weight = value.value * static_cast<float>(1 / value.pdf);
  return sample;
}

BsdfValue evaluate(const PrincipledBsdf& bsdf, const Vec3& wi) {
  const Vec3 i = bsdf.frame.to_local(wi);
  BsdfValue sum;
  if (!(dot(wi, bsdf.geometric) * i.z > 0)) {
    return sum;
  }
  if (i.z < 0) {
    if (bsdf.refracting > 0) {
      add_refraction(bsdf, i, sum);
    }
    return sum;
  }
  const Vec3 half = bsdf.o + i;
  const double size = length(half);
  if (!(size > 0)) {
    return sum;
  }
  const Vec3 h = half / size;
  add_specular(bsdf, i, h, sum);
  if (!bsdf.inside) {
    sum.value += disney_diffuse(bsdf.diffuse, bsdf.matte, bsdf.o, i, h);
    sum.pdf += bsdf.chances[kDiffuse] * cosine_hemisphere_pdf(i.z);
    if (bsdf.clearcoat > 0) {
      add_coat(bsdf, i, h, sum);
    }
  }
  return sum;
}

}  // namespace bandsaw
