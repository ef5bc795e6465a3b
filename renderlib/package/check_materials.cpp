#include <cmath>
#include <cstring>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/package/check.h"
#include "renderlib/package/limits.h"
#include "renderlib/package/manifest.h"
#include "renderlib/texture/check_texture.h"

namespace bandsaw {
namespace {

absl::Status check_side(std::uint32_t side, const std::string& field) {
  if (side < 1 || side > kMaxTextureSide) {
    return manifest_error(field, absl::StrCat("must lie in [1, ", kMaxTextureSide, "], is ", side));
  }
  return absl::OkStatus();
}

absl::Status check_texels(const ImageTexture& image, const std::string& field) {
  if (image.format != ImageTexture::Format::kFloat32) {
    return absl::OkStatus();
  }
  for (std::size_t i = 0; i < image.texels.size() / sizeof(float); ++i) {
    float value = 0;
    std::memcpy(&value, image.texels.data() + i * sizeof(float), sizeof(float));
    if (!std::isfinite(value) || value < 0) {
      const std::size_t texel = i / image.channels;
      return manifest_error(field,
                            absl::StrCat("texel (", texel % image.width, ", ", texel / image.width,
                                         ") must be finite and >= 0, is ", value));
    }
  }
  return absl::OkStatus();
}

struct CheckTexture {
  const std::string& field;

  absl::Status operator()(const ConstantTexture& texture) const {
    const Rgb& c = texture.value;
    if (!is_finite(c) || c.r < 0 || c.g < 0 || c.b < 0) {
      return manifest_error(field + ".constant.rgb", absl::StrCat("must be finite and >= 0, is [",
                                                                  c.r, ", ", c.g, ", ", c.b, "]"));
    }
    return absl::OkStatus();
  }

  absl::Status operator()(const ImageTexture& image) const {
    RETURN_IF_ERROR(check_side(image.width, field + ".image.width"));
    RETURN_IF_ERROR(check_side(image.height, field + ".image.height"));
    const std::uint64_t expected = texel_bytes(image);
    if (image.texels.size() != expected) {
      return manifest_error(field + ".image.texels",
                            absl::StrCat("must have ", expected, " bytes for ", image.width, " x ",
                                         image.height, " texels, has ", image.texels.size()));
    }
    return check_texels(image, field + ".image.texels");
  }

  // Those that are made of others or computed: texture/check_texture.h.
  template <class Computed>
  absl::Status operator()(const Computed&) const {
    return absl::OkStatus();
  }
};

absl::Status check_texture_id(const SceneDescription& scene, TextureId id,
                              const std::string& field) {
  if (index_of(id) >= scene.textures.size()) {
    return manifest_error(field, absl::StrCat("is ", index_of(id), ", there are ",
                                              scene.textures.size(), " textures"));
  }
  return absl::OkStatus();
}

absl::Status check_reflectance(const SceneDescription& scene, TextureId id,
                               const std::string& field) {
  RETURN_IF_ERROR(check_texture_id(scene, id, field));
  const float most = max_value(scene.textures, id);
  if (most > 1) {
    return manifest_error(field, absl::StrCat("a reflectance must lie in [0, 1], texture ",
                                              index_of(id), " holds ", most));
  }
  return absl::OkStatus();
}

absl::Status check_number(double value, double least, double most, const std::string& field) {
  if (!(value >= least && value <= most)) {
    return manifest_error(field, absl::StrCat("must lie in [", least, ", ", most, "], is ", value));
  }
  return absl::OkStatus();
}

struct CheckMaterial {
  const SceneDescription& scene;
  const std::string& field;

  absl::Status operator()(const Diffuse& m) const {
    return check_reflectance(scene, m.reflectance, field + ".diffuse.reflectance");
  }
  absl::Status operator()(const Metal& m) const {
    RETURN_IF_ERROR(check_reflectance(scene, m.reflectance, field + ".metal.reflectance"));
    RETURN_IF_ERROR(check_map(m.fuzz_map, field + ".metal.fuzz_texture"));
    return check_number(m.fuzz, 0, 1, field + ".metal.fuzz");
  }
  absl::Status operator()(const Dielectric& m) const {
    RETURN_IF_ERROR(
        check_number(m.index_of_refraction, 1, 5, field + ".dielectric.index_of_refraction"));
    RETURN_IF_ERROR(check_map(m.roughness_map, field + ".dielectric.roughness_texture"));
    RETURN_IF_ERROR(check_map(m.index_map, field + ".dielectric.index_texture"));
    if (m.index_map && m.priority > 0) {
      return manifest_error(field + ".dielectric.index_texture",
                            "a glass with a priority has one index of refraction");
    }
    return check_number(m.roughness, 0, 1, field + ".dielectric.roughness");
  }
  absl::Status operator()(const Emissive& m) const {
    return check_texture_id(scene, m.radiance, field + ".emissive.radiance");
  }
  absl::Status operator()(const Principled& m) const {
    const std::string path = field + ".gltf";
    RETURN_IF_ERROR(check_reflectance(scene, m.base_color.texture, path + ".base_color.texture"));
    RETURN_IF_ERROR(
        check_number(max_component(m.base_color.factor), 0, 1, path + ".base_color.factor"));
    RETURN_IF_ERROR(check_tint(m.base_color, path + ".base_color"));
    RETURN_IF_ERROR(check_tint(m.emissive, path + ".emissive"));
    RETURN_IF_ERROR(check_channel(m.metallic, path + ".metallic"));
    RETURN_IF_ERROR(check_channel(m.roughness, path + ".roughness"));
    RETURN_IF_ERROR(check_channel(m.alpha, path + ".alpha"));
    RETURN_IF_ERROR(check_channel(m.coat, path + ".coat"));
    RETURN_IF_ERROR(check_channel(m.coat_roughness, path + ".coat_roughness"));
    RETURN_IF_ERROR(check_channel(m.transmission, path + ".transmission"));
    RETURN_IF_ERROR(check_map(m.normal, path + ".normal"));
    RETURN_IF_ERROR(check_map(m.coat_normal, path + ".coat_normal"));
    RETURN_IF_ERROR(check_map(m.index_map, path + ".index_texture"));
    constexpr double kMax = 1e30;
    RETURN_IF_ERROR(check_number(m.coat_normal_scale, -kMax, kMax, path + ".coat_normal_scale"));
    RETURN_IF_ERROR(check_number(m.normal_scale, -kMax, kMax, path + ".normal_scale"));
    RETURN_IF_ERROR(check_number(m.alpha_cutoff, 0, kMax, path + ".alpha_cutoff"));
    return check_number(m.index_of_refraction, 1, 5, path + ".index_of_refraction");
  }
  absl::Status check_map(const std::optional<TextureId>& map, const std::string& path) const {
    return map ? check_texture_id(scene, *map, path) : absl::OkStatus();
  }
  absl::Status check_channel(const Channel& channel, const std::string& path) const {
    RETURN_IF_ERROR(check_number(channel.factor, 0, 1, path + ".factor"));
    return check_texture_id(scene, channel.texture, path + ".texture");
  }
  absl::Status check_tint(const Tint& tint, const std::string& path) const {
    const Rgb& c = tint.factor;
    if (!is_finite(c) || c.r < 0 || c.g < 0 || c.b < 0) {
      return manifest_error(path + ".factor", "must be finite and >= 0");
    }
    return check_texture_id(scene, tint.texture, path + ".texture");
  }
};

}  // namespace

absl::Status check_materials(const SceneDescription& scene) {
  std::vector<std::uint64_t> cost;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    const std::string field = absl::StrCat("texture[", i, "]");
    if (const absl::Status parts = check_parts(scene.textures, i, cost); !parts.ok()) {
      return manifest_error(field, std::string(parts.message()));
    }
    RETURN_IF_ERROR(std::visit(CheckTexture{field}, scene.textures[i]));
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const std::string field = absl::StrCat("material[", i, "]");
    RETURN_IF_ERROR(std::visit(CheckMaterial{scene, field}, scene.materials[i]));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
