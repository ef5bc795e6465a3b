// The BSDF has four lobes: specular and diffuse, each reflected and transmitted. Transmission is
// computed as a reflection that is mirrored to the other side. sample() chooses a lobe; evaluate()
// adds up value and pdf of all.

#include "renderlib/material/thin_principled_bsdf.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/shading_normal.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

enum Lobe : std::size_t { kReflection, kTransmission, kDiffuse, kDiffuseTransmission };

/// Minimum albedo that the selection of lobes assumes for a lobe, so that a dark lobe is not
/// sampled too rarely.
constexpr double kMinThinAlbedo = 0.1;

/// Adds value and pdf of the specular reflection. i is wi in the frame, h the half vector.
void add_reflection(const ThinPrincipledBsdf& bsdf, const Vec3& i, const Vec3& h, BsdfValue& sum) {
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  const Rgb f0 = hue_of(bsdf.diffuse.base) * static_cast<float>(normal_reflectance(bsdf.eta));
  const Rgb reflected = lerp(gray(static_cast<float>(fresnel(o_h, bsdf.eta))), schlick(f0, o_h),
                             static_cast<float>(bsdf.spec_tint));
  const double pdf = facet_pdf_over_cos(bsdf.o, h, bsdf.facets) / 4;
  const double seen = bsdf.spec_trans * pdf * facet_shadowing(bsdf.o, i, bsdf.facets);
  sum.value += reflected * static_cast<float>(seen);
  sum.pdf += bsdf.chances[kReflection] * pdf;
}

/// Returns true if a facet with the normal `h` transmits to wi; `i` is wi mirrored to the side of
/// wo. In Mitsuba's definition, a facet transmits only if wi is behind it.
bool transmits_to(const Vec3& h, const Vec3& i) { return h.x * i.x + h.y * i.y - h.z * i.z < 0; }

/// Adds value and pdf of the specular transmission. `i` is wi mirrored to the side of wo, `h` the
/// half vector of wo and `i`.
void add_transmission(const ThinPrincipledBsdf& bsdf, const Vec3& i, const Vec3& h,
                      BsdfValue& sum) {
  if (!transmits_to(h, i)) {
    return;
  }
  const double o_h = std::min(1.0, dot(bsdf.o, h));
  const double pdf = facet_pdf_over_cos(bsdf.o, h, bsdf.straight) / 4;
  const double seen = bsdf.spec_trans * (1 - fresnel(o_h, bsdf.eta)) * pdf *
                      facet_shadowing(bsdf.o, i, bsdf.straight);
  sum.value += bsdf.diffuse.base * static_cast<float>(seen);
  sum.pdf += bsdf.chances[kTransmission] * pdf;
}

/// Sets the selection probabilities in proportion to rough estimates of the lobes' albedos.
void choose_chances(ThinPrincipledBsdf& bsdf) {
  const double base = max_component(bsdf.diffuse.base);
  const double f = fresnel(std::min(1.0, bsdf.o.z), bsdf.eta);
  const double rough = 1 - bsdf.spec_trans;
  const double sheen = 0.25 * double{max_component(bsdf.diffuse.sheen)};
  const auto weight = [](double share, double albedo) {
    return share * std::max(kMinThinAlbedo, albedo);
  };
  bsdf.chances[kReflection] = weight(bsdf.spec_trans, f);
  bsdf.chances[kTransmission] = weight(bsdf.spec_trans, base * (1 - f));
  bsdf.chances[kDiffuse] = weight(rough * (1 - bsdf.diff_trans), base + sheen);
  bsdf.chances[kDiffuseTransmission] = weight(rough * bsdf.diff_trans, base);
  double sum = 0;
  for (const double chance : bsdf.chances) {
    sum += chance;
  }
  for (double& chance : bsdf.chances) {
    chance = sum > 0 ? chance / sum : 0;
  }
}

}  // namespace

ThinPrincipledBsdf thin_principled_at(const ThinPrincipled& material,
                                      absl::Span<const Texture> textures, const SurfacePoint& point,
                                      const SidedNormals& normal, const Vec3& wo) {
  const auto number = [&](const Number& n) { return number_at(n, textures, point); };
  ThinPrincipledBsdf bsdf;
  bsdf.geometric = normal.geometric;
  bsdf.eta = material.index_of_refraction;
  const double anisotropic = number(material.anisotropic);
  const double roughness = number(material.roughness);
  bsdf.facets = principled_facets(roughness, anisotropic);
  // Burley 2015, figure 15: a sheet of larger index blurs the transmitted light more.
  bsdf.straight = principled_facets((0.65 * bsdf.eta - 0.35) * roughness, anisotropic);
  bsdf.frame = facet_frame(point, facing_normal(normal.shading, normal.geometric, wo),
                           bsdf.facets.isotropic());
  bsdf.o = bsdf.frame.to_local(wo);
  const Rgb base = tinted(look_up(textures, material.base_color, point), point.color);
  bsdf.spec_trans = number(material.spec_trans);
  bsdf.spec_tint = number(material.spec_tint);
  bsdf.diff_trans = number(material.diff_trans);
  const double matte = (1 - bsdf.spec_trans) * (1 - bsdf.diff_trans);
  const auto sheen = static_cast<float>(number(material.sheen) * matte);
  const auto sheen_tint = static_cast<float>(number(material.sheen_tint));
  bsdf.diffuse = {base, roughness, number(material.flatness),
                  lerp(gray(1), hue_of(base), sheen_tint) * sheen};
  choose_chances(bsdf);
  return bsdf;
}

std::optional<BsdfSample> sample(const ThinPrincipledBsdf& bsdf, double u, double v, double lobe) {
  std::size_t chosen = 0;
  for (double left = lobe; chosen < kDiffuseTransmission && left >= bsdf.chances[chosen];
       ++chosen) {
    left -= bsdf.chances[chosen];
  }
  if (bsdf.chances[chosen] == 0) {
    return std::nullopt;  // all lobes are black, or rounding went past the last lobe
  }
  Vec3 i;
  if (chosen == kDiffuse || chosen == kDiffuseTransmission) {
    i = sample_cosine_hemisphere(u, v);
  } else {
    const Facets& facets = chosen == kReflection ? bsdf.facets : bsdf.straight;
    const Vec3 h = sample_facet(bsdf.o, facets, u, v);
    i = mirrored(bsdf.o, h);
    if (i.z <= 0 || (chosen == kTransmission && !transmits_to(h, i))) {
      return std::nullopt;
    }
  }
  const bool passes = chosen == kTransmission || chosen == kDiffuseTransmission;
  i.z = passes ? -i.z : i.z;
  BsdfSample sample;
  sample.wi = normalize(bsdf.frame.to_world(i));
  const BsdfValue value = evaluate(bsdf, sample.wi);
  if (!(value.pdf > 0) || !std::isfinite(value.pdf)) {
    return std::nullopt;
  }
  sample.pdf = value.pdf;
  sample.weight = value.value * static_cast<float>(1 / value.pdf);
  return sample;
}

BsdfValue evaluate(const ThinPrincipledBsdf& bsdf, const Vec3& wi) {
  const Vec3 i = bsdf.frame.to_local(wi);
  BsdfValue sum;
  if (!(dot(wi, bsdf.geometric) * i.z > 0)) {
    return sum;
  }
  const bool passes = i.z < 0;
  const Vec3 above{i.x, i.y, std::abs(i.z)};
  const Vec3 h = normalize(bsdf.o + above);
  const double pdf = cosine_hemisphere_pdf(above.z);
  const double rough = 1 - bsdf.spec_trans;
  if (passes) {
    if (bsdf.spec_trans > 0) {
      add_transmission(bsdf, above, h, sum);
    }
    sum.value += bsdf.diffuse.base * static_cast<float>(rough * bsdf.diff_trans * pdf);
    sum.pdf += bsdf.chances[kDiffuseTransmission] * pdf;
    return sum;
  }
  if (bsdf.spec_trans > 0) {
    add_reflection(bsdf, above, h, sum);
  }
  sum.value += disney_diffuse(bsdf.diffuse, rough * (1 - bsdf.diff_trans), bsdf.o, above, h);
  sum.pdf += bsdf.chances[kDiffuse] * pdf;
  return sum;
}

}  // namespace bandsaw
