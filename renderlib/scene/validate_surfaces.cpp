#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/scene/validate_field.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

absl::Status check_side(const std::string& field, std::uint32_t side) {
  return side >= 1 && side <= kMaxTextureSide
             ? absl::OkStatus()
             : invalid(field, absl::StrCat("must be in [1, ", kMaxTextureSide, "], is ", side));
}

absl::Status check_image(const std::string& field, const ImageTexture& image) {
  RETURN_IF_ERROR(check_side(field + ".width", image.width));
  RETURN_IF_ERROR(check_side(field + ".height", image.height));
  const std::uint64_t size = texel_bytes(image);
  if (image.texels.size() != size) {
    return invalid(field + ".texels",
                   absl::StrCat("must have ", size, " bytes for ", image.width, " x ", image.height,
                                " texels, has ", image.texels.size()));
  }
  if (image.format != ImageTexture::Format::kFloat32) {
    return absl::OkStatus();  // Decoded 8-bit values are always in [0, 1].
  }
  for (std::size_t i = 0; i < image.texels.size() / sizeof(float); ++i) {
    float value = 0;
    std::memcpy(&value, image.texels.data() + i * sizeof value, sizeof value);
    if (!std::isfinite(value) || value < 0) {
      const std::size_t texel = i / image.channels;
      return invalid(field + ".texels",
                     absl::StrCat("texel (", texel % image.width, ", ", texel / image.width,
                                  ") must be finite and not negative, is ", value));
    }
  }
  return absl::OkStatus();
}

absl::Status check_textures(const std::vector<Texture>& textures) {
  std::vector<std::uint64_t> cost;
  for (std::size_t i = 0; i < textures.size(); ++i) {
    const std::string field = item("textures", i);
    if (const absl::Status parts = check_parts(textures, i, cost); !parts.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(field, ".", parts.message()));
    }
    if (const auto* constant = std::get_if<ConstantTexture>(&textures[i])) {
      RETURN_IF_ERROR(check_color(field, constant->value, static_cast<float>(kInfinity)));
    }
    if (const auto* image = std::get_if<ImageTexture>(&textures[i])) {
      RETURN_IF_ERROR(check_image(field, *image));
    }
  }
  return absl::OkStatus();
}

/// Checks the index of a texture and that it reaches no value above `max`. The texture itself has
/// been checked.
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

/// Maximum magnitude of the scale of a normal map and of an alpha cutoff.
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

absl::Status check_principled(const std::string& field, const Principled& m,
                              const std::vector<Texture>& textures) {
  RETURN_IF_ERROR(check_texture(field + ".base_color", m.base_color.texture, textures, 1));
  RETURN_IF_ERROR(check_color(field + ".base_color.factor", m.base_color.factor, 1));
  const auto infinite = static_cast<float>(kInfinity);
  RETURN_IF_ERROR(check_texture(field + ".emissive", m.emissive.texture, textures, infinite));
  RETURN_IF_ERROR(check_color(field + ".emissive.factor", m.emissive.factor, infinite));
  RETURN_IF_ERROR(check_channel(field + ".metallic", m.metallic, textures));
  RETURN_IF_ERROR(check_channel(field + ".roughness", m.roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".alpha", m.alpha, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat", m.coat, textures));
  RETURN_IF_ERROR(check_channel(field + ".coat_roughness", m.coat_roughness, textures));
  RETURN_IF_ERROR(check_channel(field + ".transmission", m.transmission, textures));
  RETURN_IF_ERROR(check_map(field + ".normal", m.normal, textures));
  RETURN_IF_ERROR(check_map(field + ".coat_normal", m.coat_normal, textures));
  RETURN_IF_ERROR(check_map(field + ".index_map", m.index_map, textures));
  RETURN_IF_ERROR(check_range(field + ".normal_scale", m.normal_scale, -kMaxScale));
  RETURN_IF_ERROR(check_range(field + ".coat_normal_scale", m.coat_normal_scale, -kMaxScale));
  RETURN_IF_ERROR(check_range(field + ".alpha_cutoff", m.alpha_cutoff, 0));
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

absl::Status check_material(const std::string& field, const Material& material,
                            const std::vector<Texture>& textures) {
  if (const auto* diffuse = std::get_if<Diffuse>(&material)) {
    return check_texture(field + ".reflectance", diffuse->reflectance, textures, 1);
  }
  if (const auto* metal = std::get_if<Metal>(&material)) {
    return check_metal(field, *metal, textures);
  }
  if (const auto* glass = std::get_if<Dielectric>(&material)) {
    return check_glass(field, *glass, textures);
  }
  if (const auto* principled = std::get_if<Principled>(&material)) {
    return check_principled(field, *principled, textures);
  }
  const auto& emissive = std::get<Emissive>(material);
  return check_texture(field + ".radiance", emissive.radiance, textures,
                       static_cast<float>(kInfinity));
}

}  // namespace

absl::Status check_surfaces(const SceneDescription& scene) {
  RETURN_IF_ERROR(check_textures(scene.textures));
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    RETURN_IF_ERROR(check_material(item("materials", i), scene.materials[i], scene.textures));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
