// bsdf_at() evaluates the material's parameters at the point. sample() and evaluate() of the simple
// BSDFs are here. The other BSDFs have files of their own with these functions, which are called
// from here.

#include "renderlib/material/bsdf.h"

#include <algorithm>
#include <cmath>

#include "renderlib/base/overloaded.h"
#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/opacity.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Returns true if light from wi can be reflected on the side of the normals.
bool reflects(const SidedNormals& normal, const Vec3& wi) {
  return dot(wi, normal.geometric) > 0 && dot(wi, normal.shading) > 0;
}

/// Returns the normals for specular reflection. If the shading normal would put wo or its mirror
/// direction on the wrong side, the geometric normal replaces it. So silhouettes of coarse meshes
/// lose no light.
SidedNormals for_mirror(const SidedNormals& normal, const Vec3& wo) {
  const bool usable =
      dot(wo, normal.shading) > 0 && dot(mirrored(wo, normal.shading), normal.geometric) > 0;
  return {normal.geometric, usable ? normal.shading : normal.geometric};
}

/// Returns the normals for specular reflection and refraction. They are those of for_mirror(), with
/// one more case: if the shading normal would put the refracted direction on wo's side of the
/// surface, the geometric normal replaces it.
SidedNormals for_glass(const SidedNormals& normal, const Vec3& wo, double eta) {
  const SidedNormals sided = for_mirror(normal, wo);
  const std::optional<double> cos_t = refracted_cos(dot(wo, sided.shading), eta);
  if (cos_t && dot(refracted(wo, sided.shading, *cos_t, eta), normal.geometric) >= 0) {
    return {normal.geometric, normal.geometric};
  }
  return sided;
}

/// Samples a direction in proportion to its cosine. std::nullopt: it lies below the surface.
std::optional<BsdfSample> sample_diffuse(const DiffuseBsdf& bsdf, double u, double v) {
  const Vec3 local = sample_cosine_hemisphere(u, v);
  // The sample is constructed in place, which is faster than to copy it into the optional.
  std::optional<BsdfSample> sample(std::in_place);
  sample->wi = orthonormal_basis(bsdf.normal.shading).to_world(local);
  sample->pdf = cosine_hemisphere_pdf(dot(sample->wi, bsdf.normal.shading));
  sample->weight = bsdf.reflectance;
  if (!reflects(bsdf.normal, sample->wi)) {
    sample.reset();
  }
  return sample;
}

/// Returns the pdf of wi, if wi is the direction of mirror + fuzz * (uniform point of the unit
/// ball). A ray along wi is inside the ball around `mirror` from t0 to t1. The ball's density,
/// integrated with t^2 along this chord, is (t1^3 - t0^3) / (4 pi fuzz^3).
double fuzz_pdf(const Vec3& mirror, double fuzz, const Vec3& wi) {
  const double c = dot(mirror, wi);
  const double half_chord2 = fuzz * fuzz - length_squared(cross(mirror, wi));
  if (c <= 0 || half_chord2 <= 0) {
    return 0;
  }
  const double half_chord = std::sqrt(half_chord2);
  return half_chord * (4 * c * c - 1 + fuzz * fuzz) / (2 * kPi * fuzz * fuzz * fuzz);
}

/// Samples the direction of a point of the ball with radius `fuzz` around the mirror direction.
/// std::nullopt: the metal absorbs the light, because the direction lies below the surface.
std::optional<BsdfSample> sample_fuzzy(const FuzzyMetalBsdf& bsdf, double u, double v, double w) {
  const Vec3 direction = bsdf.mirror + bsdf.fuzz * sample_ball(u, v, w);
  const double size = length(direction);
  if (size < 1e-100) {  // no direction: only possible if fuzz is 1
    return std::nullopt;
  }
  BsdfSample sample;
  sample.wi = direction / size;
  sample.pdf = fuzz_pdf(bsdf.mirror, bsdf.fuzz, sample.wi);
  sample.weight = bsdf.reflectance;
  if (sample.pdf <= 0 || !reflects(bsdf.normal, sample.wi)) {
    return std::nullopt;
  }
  return sample;
}

/// Reflects wo with the probability of the Fresnel reflectance, and refracts it otherwise. `lobe`
/// is a random number that chooses between the two.
std::optional<BsdfSample> sample_dielectric(const DielectricBsdf& bsdf, double lobe) {
  const Vec3& n = bsdf.normal.shading;
  const double cos_i = std::min(1.0, dot(bsdf.wo, n));
  BsdfSample sample;
  sample.delta = true;
  sample.weight = gray(1);
  if (lobe < fresnel(cos_i, bsdf.eta)) {
    sample.wi = normalize(mirrored(bsdf.wo, n));
    return sample;
  }
  const std::optional<double> cos_t = refracted_cos(cos_i, bsdf.eta);
  if (!cos_t) {
    return std::nullopt;
  }
  sample.wi = normalize(refracted(bsdf.wo, n, *cos_t, bsdf.eta));
  sample.compression = 1 / (bsdf.eta * bsdf.eta);
  sample.weight = gray(static_cast<float>(sample.compression));
  return sample;
}

/// Returns the BSDF of a metal with this fuzz; a mirror if `fuzz` is below kMinFuzz.
Bsdf metal_at(const Rgb& reflectance, double fuzz, const SidedNormals& normal, const Vec3& wo) {
  const SidedNormals sided = for_mirror(normal, wo);
  const Vec3 mirror = normalize(mirrored(wo, sided.shading));
  if (fuzz < kMinFuzz) {
    return MirrorBsdf{reflectance, mirror};
  }
  return FuzzyMetalBsdf{sided, reflectance, mirror, fuzz};
}

/// Returns the facets of glass, from its `surface` if that is set, otherwise from its roughness;
/// std::nullopt where it is smooth.
std::optional<Facets> facets_of(const Dielectric& glass, absl::Span<const Texture> textures,
                                const SurfacePoint& point) {
  if (glass.surface) {
    return facets_at(*glass.surface, textures, point);
  }
  const double roughness = mapped_number(textures, glass.roughness, glass.roughness_map, point);
  const double alpha = roughness * roughness;
  return alpha < kMinAlpha ? std::nullopt
                           : std::optional(Facets{alpha, alpha, Microfacets::Distribution::kGgx,
                                                  Microfacets::Masking::kCorrelated});
}

/// Returns the BSDF of glass. `index` and `facets` are those at the point. `outside` is true if wo
/// is on the side of the geometric normal. `outside_index` is the index of refraction on the side
/// of the geometric normal.
Bsdf glass_at(double index, const std::optional<Facets>& facets, const SurfacePoint& point,
              const SidedNormals& normal, bool outside, const Vec3& wo, double outside_index) {
  const double relative = outside_index == 1 ? index : index / outside_index;
  const double eta = outside ? relative : 1 / relative;
  if (!facets || std::abs(eta - 1) < kMinRefraction) {
    return DielectricBsdf{for_glass(normal, wo, eta), wo, eta};
  }
  const Vec3 shading = visible_normal(normal.shading, normal.geometric, wo);
  return RoughDielectricBsdf{normal.geometric, facet_frame(point, shading, facets->isotropic()), wo,
                             eta, *facets};
}

/// Returns the BSDF of a metal that is given by its index of refraction. `specular` and `facets`
/// are those at the point. Where the metal has no facets, it is a mirror.
Bsdf conductor_at(const Conductor& metal, const Rgb& specular, const std::optional<Facets>& facets,
                  const SurfacePoint& point, const SidedNormals& normal, const Vec3& wo) {
  if (!facets) {
    const SidedNormals sided = for_mirror(normal, wo);
    const Rgb reflected = conductor_reflectance(metal.index, std::min(1.0, dot(wo, sided.shading)));
    return MirrorBsdf{reflected * specular, normalize(mirrored(wo, sided.shading))};
  }
  const Vec3 shading = facing_normal(normal.shading, normal.geometric, wo);
  return RoughConductorBsdf{
      normal.geometric, facet_frame(point, shading, facets->isotropic()), wo, *facets, metal.index,
      specular};
}

}  // namespace

Bsdf bsdf_at(const Material& material, absl::Span<const Texture> textures,
             const SurfacePoint& point, const Vec3& wo, double outside_index) {
  const bool outside = dot(wo, point.geometric_normal) >= 0;
  if (material.one_sided && !outside) {
    return BlackBsdf{};
  }
  const auto sided = [&](const Vec3& shading) {
    return outside ? SidedNormals{point.geometric_normal, shading}
                   : SidedNormals{-point.geometric_normal, -shading};
  };
  if (const auto* layered = std::get_if<MetallicRoughness>(&material.kind)) {
    return metallic_roughness_at(*layered, material.relief, textures, point,
                                 sided(point.shading_normal), wo);
  }
  const SidedNormals normal = sided(bent_normal(material.relief, textures, point));
  const auto color = [&](TextureId id) {
    return tinted(look_up(textures, id, point), point.color);
  };
  return std::visit(
      Overloaded{
          [&](const Diffuse& m) -> Bsdf {
            return DiffuseBsdf{normal, color(m.reflectance)};
          },
          [&](const Metal& m) {
            const double fuzz = mapped_number(textures, m.fuzz, m.fuzz_map, point);
            return metal_at(color(m.reflectance), fuzz, normal, wo);
          },
          [&](const Dielectric& m) {
            const double index = mapped_index(textures, m.index_of_refraction, m.index_map, point);
            return glass_at(index, facets_of(m, textures, point), point, normal, outside, wo,
                            outside_index);
          },
          [&](const Plastic& m) -> Bsdf { return plastic_at(m, textures, point, normal, wo); },
          [&](const Conductor& m) {
            return conductor_at(m, color(m.specular), facets_at(m.surface, textures, point), point,
                                normal, wo);
          },
          [&](const ThinDielectric& m) -> Bsdf {
            return thin_dielectric(m, for_mirror(normal, wo), wo);
          },
          [&](const DiffuseTransmission& m) -> Bsdf {
            return diffuse_transmission(normal, color(m.reflectance), color(m.transmittance));
          },
          [&](const Principled& m) -> Bsdf {
            return principled_at(m, textures, point, normal, outside, wo);
          },
          [&](const ThinPrincipled& m) -> Bsdf {
            return thin_principled_at(m, textures, point, normal, wo);
          },
          [](const Mix&) -> Bsdf { return BlackBsdf{}; },                // not allowed here
          [](const MetallicRoughness&) -> Bsdf { return BlackBsdf{}; },  // handled above
          [](const Emissive&) -> Bsdf { return BlackBsdf{}; }},
      material.kind);
}

std::optional<BsdfSample> sample(const Bsdf& bsdf, double u, double v, double lobe) {
  using Result = std::optional<BsdfSample>;
  return std::visit(Overloaded{[](const BlackBsdf&) -> Result { return std::nullopt; },
                               [&](const DiffuseBsdf& b) { return sample_diffuse(b, u, v); },
                               [&](const FuzzyMetalBsdf& b) { return sample_fuzzy(b, u, v, lobe); },
                               [](const MirrorBsdf& b) -> Result {
                                 return BsdfSample{
                                     .wi = b.mirror, .weight = b.reflectance, .delta = true};
                               },
                               [&](const DielectricBsdf& b) { return sample_dielectric(b, lobe); },
                               [&](const RoughConductorBsdf& b) { return sample(b, u, v); },
                               [&](const ThinDielectricBsdf& b) { return sample(b, lobe); },
                               [&](const auto& b) { return sample(b, u, v, lobe); }},
                    bsdf);
}

BsdfValue evaluate(const Bsdf& bsdf, const Vec3& wi) {
  if (const auto* diffuse = std::get_if<DiffuseBsdf>(&bsdf); diffuse != nullptr) {
    if (!reflects(diffuse->normal, wi)) {
      return {};
    }
    const double pdf = cosine_hemisphere_pdf(dot(wi, diffuse->normal.shading));
    return {diffuse->reflectance * static_cast<float>(pdf), pdf};
  }
  if (const auto* metal = std::get_if<FuzzyMetalBsdf>(&bsdf); metal != nullptr) {
    if (!reflects(metal->normal, wi)) {
      return {};
    }
    const double pdf = fuzz_pdf(metal->mirror, metal->fuzz, wi);
    return {metal->reflectance * static_cast<float>(pdf), pdf};
  }
  return std::visit(Overloaded{[](const BlackBsdf&) { return BsdfValue{}; },
                               [](const DiffuseBsdf&) { return BsdfValue{}; },  // handled above
                               [](const FuzzyMetalBsdf&) { return BsdfValue{}; },
                               [](const MirrorBsdf&) { return BsdfValue{}; },
                               [](const DielectricBsdf&) { return BsdfValue{}; },
                               [](const ThinDielectricBsdf&) { return BsdfValue{}; },
                               [&](const auto& b) { return evaluate(b, wi); }},
                    bsdf);
}

bool has_pdf(const Bsdf& bsdf) {
  return !std::holds_alternative<BlackBsdf>(bsdf) && !std::holds_alternative<MirrorBsdf>(bsdf) &&
         !std::holds_alternative<DielectricBsdf>(bsdf) &&
         !std::holds_alternative<ThinDielectricBsdf>(bsdf);
}

bool has_pdf_behind(const Bsdf& bsdf) {
  return std::visit(
      Overloaded{
          [](const RoughDielectricBsdf&) { return true; },
          [](const MetallicRoughnessBsdf& b) { return b.transmission > 0 && b.metallic < 1; },
          [](const PrincipledBsdf& b) { return b.refracting > 0; },
          [](const ThinPrincipledBsdf& b) { return b.spec_trans > 0 || b.diff_trans > 0; },
          [](const DiffuseTransmissionBsdf& b) { return !is_black(b.transmittance); },
          [](const auto&) { return false; }},
      bsdf);
}

bool is_diffuse_behind(const Bsdf& bsdf) {
  if (const auto* thin = std::get_if<ThinPrincipledBsdf>(&bsdf)) {
    return thin->diff_trans > 0 && thin->spec_trans < 1;
  }
  const auto* sheet = std::get_if<DiffuseTransmissionBsdf>(&bsdf);
  return sheet != nullptr && !is_black(sheet->transmittance);
}

}  // namespace bandsaw
