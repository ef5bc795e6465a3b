// The BSDF has four lobes: coat, reflection, diffuse light and transmission. sample() chooses one
// by its estimated contribution; evaluate() adds up all of them, so the pdf is that of all lobes
// together.

#include "renderlib/material/metallic_roughness_bsdf.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/fresnel.h"
#include "renderlib/material/ggx.h"
#include "renderlib/material/ggx_albedo.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

enum Lobe : std::size_t { kCoat, kReflection, kDiffuse, kTransmission };

/// The directions wo (o) and wi (i) in the frame of one normal.
struct Local {
  Vec3 o;
  Vec3 i;
};

/// Returns wo and wi in a frame whose z is `normal`.
Local local(const Vec3& normal, const Vec3& wo, const Vec3& wi) {
  const Basis frame = orthonormal_basis(normal);
  return {frame.to_local(wo), frame.to_local(wi)};
}

/// A reflection without its Fresnel factor: pdf, value, and Schlick's (1 - cos)^5.
struct Reflection {
  double pdf = 0;
  double value = 0;
  double rim = 0;
};

/// Returns the reflection from o, which is wo, to i, which is wi; all zero if there is none. o and
/// i are in the frame of the normal.
Reflection reflection(const Vec3& o, const Vec3& i, double alpha) {
  const Vec3 sum = o + i;
  const double size = length(sum);
  if (i.z <= 0 || o.z <= 0 || !(size > 0)) {
    return {};
  }
  const Vec3 h = sum / size;
  Reflection out;
  out.pdf = ggx_visible_over_cos(o, h, alpha) / 4;
  out.value = out.pdf * ggx_shadowing(o, i, alpha);
  out.rim = schlick_rim(dot(o, h));
  return out;
}

/// Returns the share of light that the coat transmits; symmetric in wo and wi.
double below_coat(const MetallicRoughnessBsdf& bsdf, const Vec3& wi) {
  if (bsdf.coat == 0) {
    return 1;
  }
  const double cos_i = std::abs(dot(wi, bsdf.coat_normal));
  const double other = bsdf.coat * ggx_albedo_table().at(cos_i, bsdf.coating.roughness)(kCoatF0);
  return 1 - std::max(bsdf.coat_albedo, other);
}

Rgb scaled(const Rgb& color, double by) { return color * static_cast<float>(by); }

/// The functions add_...() add value and pdf of their lobes to `sum`. `through` is below_coat().
void add_coat(const MetallicRoughnessBsdf& bsdf, const Vec3& wi, BsdfValue& sum) {
  const Local directions = local(bsdf.coat_normal, bsdf.wo, wi);
  const Reflection coat = reflection(directions.o, directions.i, bsdf.coating.alpha);
  const double fresnel = kCoatF0 + (1 - kCoatF0) * coat.rim;
  sum.value += gray(static_cast<float>(bsdf.coat * coat.value * fresnel));
  sum.pdf += bsdf.chances[kCoat] * coat.pdf;
}

/// Returns the value of the diffuse part, for wi on the side of wo. `through`: the share of the
/// light that passes the coat. With the albedo a of the reflection, the diffuse light has the
/// factor (1 - a(wo)) (1 - a(wi)) / (1 - mean of a) (Kelemen and Szirmay-Kalos 2001, eq. 5). `left`
/// is 1 - a(wi), and matte_share is the rest of the factor.
Rgb diffuse(const MetallicRoughnessBsdf& bsdf, const Local& directions, double through) {
  const double matte = (1 - bsdf.metallic) * (1 - bsdf.transmission);
  if (!(matte > 0)) {
    return {};
  }
  const double pdf = cosine_hemisphere_pdf(directions.i.z);
  const double left = 1 - ggx_albedo_table().at(directions.i.z, bsdf.surface.roughness)(bsdf.f0);
  return scaled(bsdf.base, matte * pdf * bsdf.matte_share * left * through);
}

/// Adds reflection and diffuse light, for wi on the side of wo.
void add_above(const MetallicRoughnessBsdf& bsdf, const Local& directions, double through,
               BsdfValue& sum) {
  const Reflection mirror = reflection(directions.o, directions.i, bsdf.surface.alpha);
  const Rgb f0 =
      lerp(gray(static_cast<float>(bsdf.f0)), bsdf.base, static_cast<float>(bsdf.metallic));
  const auto rim = static_cast<float>(mirror.rim);
  sum.value += scaled(f0 * (1 - rim) + gray(rim), mirror.value * through);
  sum.pdf += bsdf.chances[kReflection] * mirror.pdf;
  sum.value += diffuse(bsdf, directions, through);
  sum.pdf += bsdf.chances[kDiffuse] * cosine_hemisphere_pdf(directions.i.z);
}

/// Adds transmission, for wi on the side opposite to wo. Transmission is computed as a reflection
/// to the direction wi mirrored to the side of wo.
void add_below(const MetallicRoughnessBsdf& bsdf, const Local& directions, double through,
               BsdfValue& sum) {
  const Reflection straight = reflection(
      directions.o, {directions.i.x, directions.i.y, -directions.i.z}, bsdf.surface.alpha);
  const double passed = (1 - bsdf.f0) * (1 - straight.rim);
  const double share = (1 - bsdf.metallic) * bsdf.transmission;
  sum.value += scaled(bsdf.base, share * passed * straight.value * through);
  sum.pdf += bsdf.chances[kTransmission] * straight.pdf;
}

/// Sets the lobes' selection probabilities in proportion to estimates of their contributions
/// towards wo. `albedo` is the albedo of the reflection, seen along wo.
void choose_chances(MetallicRoughnessBsdf& bsdf, const GgxAlbedo& albedo) {
  const double through = 1 - bsdf.coat_albedo;
  const double base = max_component(bsdf.base);
  const double f0 = bsdf.f0 + (base - bsdf.f0) * bsdf.metallic;
  const double left = 1 - albedo(bsdf.f0);
  bsdf.chances[kCoat] = bsdf.coat_albedo;
  bsdf.chances[kReflection] = through * albedo(f0);
  bsdf.chances[kDiffuse] = through * (1 - bsdf.metallic) * (1 - bsdf.transmission) * base * left;
  bsdf.chances[kTransmission] = through * (1 - bsdf.metallic) * bsdf.transmission * base * left;
  double sum = 0;
  for (const double chance : bsdf.chances) {
    sum += chance;
  }
  for (double& chance : bsdf.chances) {
    chance = sum > 0 ? chance / sum : 0;
  }
}

GgxLobe lobe_of(double roughness) {
  return {roughness, std::max(kMinAlpha, roughness * roughness)};
}

}  // namespace

MetallicRoughnessBsdf metallic_roughness_at(const MetallicRoughness& material, const Relief& relief,
                                            absl::Span<const Texture> textures,
                                            const SurfacePoint& point, const SidedNormals& normal,
                                            const Vec3& wo) {
  const auto texel = [&](TextureId id) { return look_up(textures, id, point); };
  const auto number = [&](const Channel& channel, float Rgb::*of) {
    return channel.factor == 0
               ? 0
               : std::clamp(channel.factor * double{texel(channel.texture).*of}, 0.0, 1.0);
  };
  MetallicRoughnessBsdf bsdf;
  bsdf.wo = wo;
  bsdf.coat_normal = visible_normal(normal.shading, normal.geometric, wo);
  bsdf.normal = {normal.geometric, bsdf.coat_normal};
  const auto visible = [&](const Vec3& outside) {
    const bool flipped = dot(point.geometric_normal, normal.geometric) < 0;
    return visible_normal(flipped ? -outside : outside, normal.geometric, wo);
  };
  if (bends(relief)) {
    bsdf.normal.shading = visible(bent_normal(relief, textures, point));
  }
  if (material.coat_normal && material.coat.factor > 0) {
    bsdf.coat_normal =
        visible(mapped_normal(point, textures, *material.coat_normal, material.coat_normal_scale));
  }
  const Rgb color = texel(material.base_color.texture) * material.base_color.factor * point.color;
  bsdf.base = {std::min(color.r, 1.0f), std::min(color.g, 1.0f), std::min(color.b, 1.0f)};
  bsdf.metallic = number(material.metallic, &Rgb::b);
  bsdf.transmission = number(material.transmission, &Rgb::r);
  bsdf.f0 = normal_reflectance(
      mapped_index(textures, material.index_of_refraction, material.index_map, point));
  bsdf.surface = lobe_of(number(material.roughness, &Rgb::g));
  bsdf.coat = number(material.coat, &Rgb::r);
  const GgxAlbedoTable& table = ggx_albedo_table();
  if (bsdf.coat > 0) {
    bsdf.coating = lobe_of(number(material.coat_roughness, &Rgb::g));
    bsdf.coat_albedo =
        bsdf.coat * table.at(dot(wo, bsdf.coat_normal), bsdf.coating.roughness)(kCoatF0);
  }
  const GgxAlbedo albedo = table.at(dot(wo, bsdf.normal.shading), bsdf.surface.roughness);
  bsdf.matte_share = (1 - albedo(bsdf.f0)) / (1 - table.mean(bsdf.surface.roughness)(bsdf.f0));
  choose_chances(bsdf, albedo);
  return bsdf;
}

std::optional<BsdfSample> sample(const MetallicRoughnessBsdf& bsdf, double u, double v,
                                 double lobe) {
  std::size_t chosen = 0;
  for (double left = lobe; chosen < kTransmission && left >= bsdf.chances[chosen]; ++chosen) {
    left -= bsdf.chances[chosen];
  }
  if (bsdf.chances[chosen] == 0) {
    return std::nullopt;  // all lobes are black, or rounding went past the last lobe
  }
  const Basis frame = orthonormal_basis(chosen == kCoat ? bsdf.coat_normal : bsdf.normal.shading);
  Vec3 i;
  if (chosen == kDiffuse) {
    i = sample_cosine_hemisphere(u, v);
  } else {
    const Vec3 o = frame.to_local(bsdf.wo);
    const double alpha = chosen == kCoat ? bsdf.coating.alpha : bsdf.surface.alpha;
    i = mirrored(o, sample_ggx_visible(o, alpha, u, v));
    if (i.z <= 0) {
      return std::nullopt;
    }
    i.z = chosen == kTransmission ? -i.z : i.z;
  }
  BsdfSample sample;
  sample.wi = normalize(frame.to_world(i));
  if ((dot(sample.wi, bsdf.normal.geometric) < 0) != (chosen == kTransmission)) {
    return std::nullopt;  // a perturbed normal moved the direction to the wrong side
  }
  const BsdfValue value = evaluate(bsdf, sample.wi);
  if (!(value.pdf > 0) || !std::isfinite(value.pdf)) {
    return std::nullopt;
  }
  sample.pdf = value.pdf;
  sample.weight = scaled(value.value, 1 / value.pdf);
  return sample;
}

BsdfValue evaluate(const MetallicRoughnessBsdf& bsdf, const Vec3& wi) {
  const double side = dot(wi, bsdf.normal.geometric);
  const Local directions = local(bsdf.normal.shading, bsdf.wo, wi);
  BsdfValue sum;
  if (side > 0) {
    if (bsdf.coat > 0) {
      add_coat(bsdf, wi, sum);
    }
    if (directions.i.z > 0) {
      add_above(bsdf, directions, below_coat(bsdf, wi), sum);
    }
  } else if (side < 0 && directions.i.z < 0 && bsdf.transmission > 0) {
    add_below(bsdf, directions, below_coat(bsdf, wi), sum);
  }
  return sum;
}

Rgb diffuse_part(const MetallicRoughnessBsdf& bsdf, const Vec3& wi) {
  const Local directions = local(bsdf.normal.shading, bsdf.wo, wi);
  return dot(wi, bsdf.normal.geometric) > 0 && directions.i.z > 0
             ? diffuse(bsdf, directions, below_coat(bsdf, wi))
             : Rgb{};
}

}  // namespace bandsaw
