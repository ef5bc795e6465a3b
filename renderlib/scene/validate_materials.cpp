// CheckKind checks the parameters of each kind of material, and check_common() checks the
// properties that every kind has.

#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/material/interiors.h"
#include "renderlib/material/mixture.h"
#include "renderlib/material/transmits.h"
#include "renderlib/scene/validate_field.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {
namespace {

/// Checks that the index of a texture is valid and that no value of the texture is above `max`. The
/// texture itself has been checked before.
absl::Status check_texture(const std::string& field, TextureId id,
                           const std::vector<Texture>& textures, float max) {
  RETURN_IF_ERROR(check_index(field, id, textures.size()));
  const float reached = max_value(textures, id);
  return reached <= max ? absl::OkStatus()
                        : invalid(field, absl::StrCat("must be in [0, ", max, "], texture ",
                                                      index_of(id), " reaches ", reached));
}

absl::Status check_unit(const std::string& field, double value) {
  return value >= 0 && value <= 1 ? absl::OkStatus()
                                  : invalid(field, absl::StrCat("must be in [0, 1], is ", value));
}

/// Maximum magnitude of the scale of a normal map or height map, and of an alpha cutoff.
constexpr double kMaxScale = 1e30;

absl::Status check_range(const std::string& field, double value, double min) {
  return value >= min && value <= kMaxScale
             ? absl::OkStatus()
             : invalid(field, absl::StrCat("must be in [", min, ", ", kMaxScale, "], is ", value));
}

absl::Status check_channel(const std::string& field, const Channel& channel,
                           const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_unit(field + ".factor", channel.factor));
  return check_index(field + ".texture", channel.texture, textures.size());
}

absl::Status check_map(const std::string& field, const std::optional<TextureId>& map,
                       const std::vector<Texture>& textures) {
  return map ? check_index(field, *map, textures.size()) : absl::OkStatus();
}

absl::Status check_refraction(const std::string& field, double index) {
  return index >= 1 && index <= 5 ? absl::OkStatus()
                                  : invalid(field + ".index_of_refraction",
                                            absl::StrCat("must be in [1, 5], is ", index));
}

absl::Status check_metallic_roughness(const std::string& field, const MetallicRoughness& m,
                                      const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_texture(field + ".base_color", m.base_color.texture, textures, 1));
  RETURN_IF_ERROR(check_color(field + ".base_color.factor", m.base_color.factor, 1));
  RETURN_IF_ERROR(check_channel(field + ".metallic", m.metallic, textures));
  RETURN_IF_ERROR(check_channel(field + ".roughness", m.roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat", m.coat, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat_roughness", m.coat_roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".transmission", m.transmission, textures));
  RETURN_IF_ERROR(check_map(field + ".coat_normal", m.coat_normal, textures));
  RETURN_IF_ERROR(check_map(field + ".index_map", m.index_map, textures));
  RETURN_IF_ERROR(check_range(field + ".coat_normal_scale", m.coat_normal_scale, -kMaxScale));
  return check_refraction(field, m.index_of_refraction);
}

absl::Status check_metal(const std::string& field, const Metal& m,
                         const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_unit(field + ".fuzz", m.fuzz));
  RETURN_IF_ERROR(check_map(field + ".fuzz_map", m.fuzz_map, textures));
  return check_texture(field + ".reflectance", m.reflectance, textures, 1);
}

absl::Status check_glass(const std::string& field, const Dielectric& m,
                         const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_refraction(field, m.index_of_refraction));
  RETURN_IF_ERROR(check_map(field + ".roughness_map", m.roughness_map, textures));
  RETURN_IF_ERROR(check_map(field + ".index_map", m.index_map, textures));
  if (m.index_map && m.priority > 0) {
    return invalid(field + ".index_map", "a glass with a priority has one index of refraction");
  }
  return check_unit(field + ".roughness", m.roughness);
}

absl::Status check_relief(const std::string& field, const Relief& relief,
                          const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_map(field + ".normal", relief.normal, textures));
  RETURN_IF_ERROR(check_range(field + ".normal_scale", relief.normal_scale, -kMaxScale));
  RETURN_IF_ERROR(check_map(field + ".height", relief.height, textures));
  RETURN_IF_ERROR(check_range(field + ".height_scale", relief.height_scale, -kMaxScale));
  if (relief.normal && relief.height) {
    return invalid(field + ".height", "a surface has a normal map or a height map, not both");
  }
  if (relief.height && uses_object_space(textures, *relief.height)) {
    return invalid(field + ".height", "a height map lies in uv or world space, not object space");
  }
  return absl::OkStatus();
}

absl::Status check_alpha(const std::string& field, const Alpha& alpha,
                         const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_range(field + ".cutoff", alpha.cutoff, 0));
  RETURN_IF_ERROR(check_unit(field + ".value.factor", alpha.value.factor));
  return alpha.mode == AlphaMode::kOpaque
             ? absl::OkStatus()
             : check_index(field + ".value.texture", alpha.value.texture, textures.size());
}

absl::Status check_emission(const std::string& field, const Emission& emission,
                            const std::vector<Texture>& textures) {
  const auto infinite = static_cast<float>(kInfinity);
  const Tint& radiance = emission.radiance;
  RETURN_IF_ERROR(check_color(field + ".radiance.factor", radiance.factor, infinite));
  return is_black(radiance.factor)
             ? absl::OkStatus()
             : check_texture(field + ".radiance", radiance.texture, textures, infinite);
}

/// Checks the properties that every kind of material can have. A glass may have a priority. Where
/// several glasses overlap, the priorities decide which glass is present (material/interiors.h).
absl::Status check_common(const std::string& field, const Material& material,
                          const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_relief(field + ".relief", material.relief, textures));
  RETURN_IF_ERROR(check_alpha(field + ".alpha", material.alpha, textures));
  RETURN_IF_ERROR(check_emission(field + ".emission", material.emission, textures));
  const bool emits = !is_black(material.emission.radiance.factor);
  if (std::holds_alternative<Emissive>(material.kind) &&
      (emits || material.alpha.mode != AlphaMode::kOpaque)) {
    return invalid(field, "an emissive material has no further emission and no alpha");
  }
  if (std::holds_alternative<Mix>(material.kind) &&
      (emits || material.alpha.mode != AlphaMode::kOpaque || material.one_sided ||
       material.relief.normal || material.relief.height)) {
    return invalid(field, "a mixture has no properties of its own; its parts have them");
  }
  if (nested_glass(material) != nullptr && material.alpha.mode != AlphaMode::kOpaque) {
    return invalid(field + ".alpha", "a glass with a priority is opaque");
  }
  if (material.one_sided && transmits(material)) {
    return invalid(field + ".one_sided", "a material that transmits light has two sides");
  }
  return absl::OkStatus();
}

absl::Status check_surface(const std::string& field, const Microfacets& surface,
                           const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_unit(field + ".alpha_u", surface.alpha_u));
  RETURN_IF_ERROR(check_unit(field + ".alpha_v", surface.alpha_v));
  RETURN_IF_ERROR(check_map(field + ".alpha_u_map", surface.alpha_u_map, textures));
  return check_map(field + ".alpha_v_map", surface.alpha_v_map, textures);
}

absl::Status check_number(const std::string& field, const Number& number,
                          const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_unit(field + ".value", number.value));
  return check_map(field + ".map", number.map, textures);
}

absl::Status check_conductor(const std::string& field, const ConductorIndex& index) {
  constexpr float kMaxIndex = 100;
  RETURN_IF_ERROR(check_color(field + ".eta", index.eta, kMaxIndex));
  RETURN_IF_ERROR(check_color(field + ".k", index.k, kMaxIndex));
  const Rgb& eta = index.eta;
  return eta.r > 0 && eta.g > 0 && eta.b > 0
             ? absl::OkStatus()
             : invalid(field + ".eta", "must be above 0 in each channel");
}

/// A number of a material, and the name of its field.
struct NamedNumber {
  const char* name;
  const Number& number;
};

absl::Status check_numbers(const std::string& field, std::initializer_list<NamedNumber> numbers,
                           const std::vector<Texture>& textures) {
  for (const auto& [name, number] : numbers) {
    RETURN_IF_ERROR(check_number(absl::StrCat(field, ".", name), number, textures));
  }
  return absl::OkStatus();
}

/// Checks the parameters of a kind of material; called by std::visit.
struct CheckKind {
  const std::string& field;
  const std::vector<Texture>& textures;

  absl::Status reflectance(const char* name, TextureId id) const {
    return check_texture(absl::StrCat(field, ".", name), id, textures, 1);
  }

  absl::Status operator()(const Diffuse& m) const {
    return reflectance("reflectance", m.reflectance);
  }
  absl::Status operator()(const Metal& m) const { return check_metal(field, m, textures); }
  absl::Status operator()(const Dielectric& m) const {
    RETURN_IF_ERROR(m.surface ? check_surface(field + ".surface", *m.surface, textures)
                              : absl::OkStatus());
    return check_glass(field, m, textures);
  }
  absl::Status operator()(const Emissive& m) const {
    return check_texture(field + ".radiance", m.radiance, textures, static_cast<float>(kInfinity));
  }
  absl::Status operator()(const MetallicRoughness& m) const {
    return check_metallic_roughness(field, m, textures);
  }
  absl::Status operator()(const Plastic& m) const {
    RETURN_IF_ERROR(reflectance("reflectance", m.reflectance));
    RETURN_IF_ERROR(check_refraction(field, m.index_of_refraction));
    RETURN_IF_ERROR(check_color(field + ".specular", m.specular, 1));
    if (m.index_of_refraction == 1) {
      return invalid(field + ".index_of_refraction",
                     "must be above 1: a coat of index 1 would reflect nothing");
    }
    if (!m.surface.isotropic()) {
      return invalid(field + ".surface", "the coat of plastic is isotropic");
    }
    return check_surface(field + ".surface", m.surface, textures);
  }
  absl::Status operator()(const Conductor& m) const {
    RETURN_IF_ERROR(m.index ? check_conductor(field, *m.index) : absl::OkStatus());
    RETURN_IF_ERROR(check_surface(field + ".surface", m.surface, textures));
    return reflectance("specular", m.specular);
  }
  absl::Status operator()(const ThinDielectric& m) const {
    RETURN_IF_ERROR(check_refraction(field, m.index_of_refraction));
    RETURN_IF_ERROR(check_color(field + ".specular", m.specular, 1));
    return check_color(field + ".transmission", m.transmission, 1);
  }
  absl::Status operator()(const DiffuseTransmission& m) const {
    RETURN_IF_ERROR(reflectance("reflectance", m.reflectance));
    return reflectance("transmittance", m.transmittance);
  }
  absl::Status operator()(const Principled& m) const {
    RETURN_IF_ERROR(reflectance("base_color", m.base_color));
    RETURN_IF_ERROR(check_refraction(field, m.index_of_refraction));
    return check_numbers(field,
                         {{"roughness", m.roughness},
                          {"anisotropic", m.anisotropic},
                          {"metallic", m.metallic},
                          {"spec_trans", m.spec_trans},
                          {"spec_tint", m.spec_tint},
                          {"sheen", m.sheen},
                          {"sheen_tint", m.sheen_tint},
                          {"flatness", m.flatness},
                          {"clearcoat", m.clearcoat},
                          {"clearcoat_gloss", m.clearcoat_gloss}},
                         textures);
  }
  absl::Status operator()(const ThinPrincipled& m) const {
    RETURN_IF_ERROR(reflectance("base_color", m.base_color));
    RETURN_IF_ERROR(check_refraction(field, m.index_of_refraction));
    return check_numbers(field,
                         {{"roughness", m.roughness},
                          {"anisotropic", m.anisotropic},
                          {"spec_trans", m.spec_trans},
                          {"spec_tint", m.spec_tint},
                          {"sheen", m.sheen},
                          {"sheen_tint", m.sheen_tint},
                          {"flatness", m.flatness},
                          {"diff_trans", m.diff_trans}},
                         textures);
  }
  absl::Status operator()(const Mix& m) const { return reflectance("amount", m.amount); }
};

/// Checks the parts of materials[index] if it is a mixture. parts[i] is the number of parts of
/// materials[i], for all i < index. The number of parts of materials[index] is appended. A mixture
/// counts as one part in addition to the parts of its two materials. A material that is no mixture
/// has one part.
absl::Status check_mixture(const std::vector<Material>& materials, std::size_t index,
                           std::vector<std::uint64_t>& parts) {
  const std::string field = item("materials", index);
  const auto* mix = std::get_if<Mix>(&materials[index].kind);
  parts.push_back(1);
  if (mix == nullptr) {
    return absl::OkStatus();
  }
  for (const auto& [name, id] : {std::pair(".a", mix->a), std::pair(".b", mix->b)}) {
    RETURN_IF_ERROR(check_index(field + name, id, index));
    if (nested_glass(materials[index_of(id)]) != nullptr) {
      return invalid(field + name, "a glass with a priority is not part of a mixture");
    }
    parts.back() += parts[index_of(id)];
  }
  return parts.back() <= kMaxMixtureParts
             ? absl::OkStatus()
             : invalid(field, absl::StrCat("is made of ", parts.back(), " materials, at most ",
                                           kMaxMixtureParts));
}

}  // namespace

absl::Status check_materials(const std::vector<Material>& materials,
                             const std::vector<Texture>& textures) {
  std::vector<std::uint64_t> parts;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const std::string field = item("materials", i);
    RETURN_IF_ERROR(check_mixture(materials, i, parts));
    RETURN_IF_ERROR(check_common(field, materials[i], textures));
    RETURN_IF_ERROR(std::visit(CheckKind{field, textures}, materials[i].kind));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
