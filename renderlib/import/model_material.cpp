#include "renderlib/import/model_material.h"

#include <assimp/GltfMaterial.h>
#include <assimp/material.h>
#include <assimp/scene.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/decode_image.h"
#include "renderlib/import/percent.h"

namespace bandsaw {
namespace {

Rgb clamped(const aiColor4D& c, float most) {
  const auto channel = [&](float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, most) : 0.0f; };
  return {channel(c.r), channel(c.g), channel(c.b)};
}

// glTF's base colour, else what every format of Assimp calls diffuse; the glTF default is white.
Rgb base_color(const aiMaterial& material) {
  aiColor4D color(1, 1, 1, 1);
  if (material.Get(AI_MATKEY_BASE_COLOR, color) != aiReturn_SUCCESS) {
    material.Get(AI_MATKEY_COLOR_DIFFUSE, color);
  }
  return clamped(color, 1);
}

Rgb emission(const aiMaterial& material) {
  aiColor4D color(0, 0, 0, 1);
  material.Get(AI_MATKEY_COLOR_EMISSIVE, color);
  float intensity = 1;
  material.Get(AI_MATKEY_EMISSIVE_INTENSITY, intensity);
  constexpr float kMost = 1e30f;
  const aiColor4D scaled(color.r * intensity, color.g * intensity, color.b * intensity, 1);
  return clamped(scaled, kMost);
}

// Reads one material; what is the same for all its messages is kept here.
class Reader {
 public:
  Reader(const aiScene& scene, unsigned index, const std::string& model_path, SceneDraft& draft)
      : scene_(scene), material_(*scene.mMaterials[index]), path_(model_path), draft_(draft) {
    aiString name;
    material_.Get(AI_MATKEY_NAME, name);
    const std::string called =
        name.length == 0 ? absl::StrCat(index) : absl::StrCat("\"", name.C_Str(), "\"");
    title_ = absl::StrCat(name_of(path_), ": material ", called);
  }

  absl::StatusOr<ModelMaterial> read() {
    const bool base_color_map = material_.GetTextureCount(aiTextureType_BASE_COLOR) > 0;
    const auto type = base_color_map ? aiTextureType_BASE_COLOR : aiTextureType_DIFFUSE;
    const bool textured = material_.GetTextureCount(type) > 0;
    const bool glow_map = material_.GetTextureCount(aiTextureType_EMISSIVE) > 0;
    float metallic = 0;
    if (material_.Get(AI_MATKEY_METALLIC_FACTOR, metallic) == aiReturn_SUCCESS) {
      return read_principled(type, textured, metallic);
    }
    const Rgb base = base_color(material_);
    const Rgb glow = emission(material_);
    if (!is_black(glow) && !textured && !glow_map) {
      return ModelMaterial{draft_.add_material(Emissive{draft_.textures.constant(glow), false}), 0};
    }
    if (!is_black(glow)) {
      warn("its emission is left out: it has a texture");
    }
    if (!textured) {
      return ModelMaterial{draft_.add_material(Diffuse{draft_.textures.constant(base)}), 0};
    }
    return read_textured(type, base);
  }

 private:
  void warn(absl::string_view what) {
    draft_.out.info.warnings.push_back(absl::StrCat(title_, ": ", what));
  }

  // A number in [least, most], or `otherwise` where the file has none.
  double number(const char* key, double otherwise, double least, double most) const {
    float value = static_cast<float>(otherwise);
    material_.Get(key, 0, 0, value);
    return std::isfinite(value) ? std::clamp(double{value}, least, most) : otherwise;
  }

  // The texture of a kind, or white. glTF's textures are all read by the base colour's uvs.
  absl::StatusOr<TextureId> map(aiTextureType type, unsigned index, bool linear, bool alpha) {
    aiString file;
    aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    if (material_.GetTexture(type, index, &file, nullptr, nullptr, nullptr, nullptr, modes) !=
        aiReturn_SUCCESS) {
      return draft_.textures.constant({1, 1, 1});
    }
    TextureStore::Use use;
    use.linear = linear;
    use.alpha = alpha;
    use.wrap = wrap_of(modes[0]);
    if (modes[0] != modes[1]) {
      use.wrap_v = wrap_of(modes[1]);
    }
    auto texture = find_texture(file.C_Str(), use);
    if (!texture.ok()) {
      return absl::Status(texture.status().code(),
                          absl::StrCat(title_, ": ", texture.status().message()));
    }
    return texture;
  }

  absl::Status read_alpha(aiTextureType type, Principled& to) {
    aiString mode;
    material_.Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
    const absl::string_view name = mode.C_Str();
    if (name != "MASK" && name != "BLEND") {
      return absl::OkStatus();
    }
    to.alpha_mode = name == "MASK" ? AlphaMode::kMask : AlphaMode::kBlend;
    to.alpha_cutoff = number("$mat.gltf.alphaCutoff", 0.5, 0, 1e30);
    aiColor4D color(1, 1, 1, 1);
    material_.Get(AI_MATKEY_BASE_COLOR, color);
    to.alpha.factor = std::isfinite(color.a) ? std::clamp(double{color.a}, 0.0, 1.0) : 1;
    ASSIGN_OR_RETURN(to.alpha.texture, map(type, 0, true, true));
    return absl::OkStatus();
  }

  absl::StatusOr<ModelMaterial> read_principled(aiTextureType type, bool textured, float metallic) {
    Principled to;
    const TextureId white = draft_.textures.constant({1, 1, 1});
    ASSIGN_OR_RETURN(to.base_color.texture, map(type, 0, false, false));
    to.base_color.factor = base_color(material_);
    ASSIGN_OR_RETURN(to.metallic.texture, map(aiTextureType_UNKNOWN, 0, true, false));
    to.roughness.texture = to.metallic.texture;
    to.metallic.factor = std::isfinite(metallic) ? std::clamp(double{metallic}, 0.0, 1.0) : 1;
    to.roughness.factor = number("$mat.roughnessFactor", 1, 0, 1);
    to.index_of_refraction = number("$mat.refracti", 1.5, 1, 5);
    to.emissive.factor = emission(material_);
    ASSIGN_OR_RETURN(to.emissive.texture, map(aiTextureType_EMISSIVE, 0, false, false));
    if (material_.GetTextureCount(aiTextureType_NORMALS) > 0) {
      ASSIGN_OR_RETURN(to.normal, map(aiTextureType_NORMALS, 0, true, false));
      float scale = 1;
      material_.Get(AI_MATKEY_GLTF_TEXTURE_SCALE(aiTextureType_NORMALS, 0), scale);
      to.normal_scale = std::isfinite(scale) ? scale : 1;
    }
    int both = 0;
    material_.Get(AI_MATKEY_TWOSIDED, both);
    to.double_sided = both != 0;
    to.alpha.texture = white;
    RETURN_IF_ERROR(read_alpha(type, to));
    to.coat.factor = number("$mat.clearcoat.factor", 0, 0, 1);
    ASSIGN_OR_RETURN(to.coat.texture, map(aiTextureType_CLEARCOAT, 0, true, false));
    to.coat_roughness.factor = number("$mat.clearcoat.roughnessFactor", 0, 0, 1);
    ASSIGN_OR_RETURN(to.coat_roughness.texture, map(aiTextureType_CLEARCOAT, 1, true, false));
    if (material_.GetTextureCount(aiTextureType_CLEARCOAT) > 2) {
      warn("the normal map of its clear coat is left out");
    }
    to.transmission.factor = number("$mat.transmission.factor", 0, 0, 1);
    ASSIGN_OR_RETURN(to.transmission.texture, map(aiTextureType_TRANSMISSION, 0, true, false));
    unsigned uv_set = 0;
    if (textured) {
      aiString file;
      material_.GetTexture(type, 0, &file, nullptr, &uv_set);
    }
    return ModelMaterial{draft_.add_material(to), uv_set};
  }

  absl::StatusOr<ModelMaterial> read_textured(aiTextureType type, const Rgb& base) {
    aiString file;
    unsigned uv_set = 0;
    aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
    material_.GetTexture(type, 0, &file, nullptr, &uv_set, nullptr, nullptr, modes);
    TextureStore::Use use;
    use.wrap = wrap_of(modes[0]);
    if (modes[0] != modes[1]) {
      use.wrap_v = wrap_of(modes[1]);
    }
    int filter = 0;
    constexpr int kGlNearest = 9728;
    if (material_.Get(AI_MATKEY_GLTF_MAPPINGFILTER_MAG(type, 0), filter) == aiReturn_SUCCESS &&
        filter == kGlNearest) {
      use.filter = ImageTexture::Filter::kNearest;
    }
    aiUVTransform transform;
    if (material_.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS) {
      warn("the transform of its texture is left out");
    }
    // Exporters that mean "the texture alone" write a black Kd.
    use.factor = is_black(base) ? Rgb{1, 1, 1} : base;
    auto texture = find_texture(file.C_Str(), use);
    if (!texture.ok()) {
      return absl::Status(texture.status().code(),
                          absl::StrCat(title_, ": ", texture.status().message()));
    }
    if (draft_.textures.max_value(*texture) > 1) {
      return absl::InvalidArgumentError(
          absl::StrCat(title_, ": a reflectance must lie in [0, 1], its texture holds ",
                       draft_.textures.max_value(*texture)));
    }
    return ModelMaterial{draft_.add_material(Diffuse{*texture}), uv_set};
  }

  static ImageTexture::Wrap wrap_of(aiTextureMapMode mode) {
    switch (mode) {
      case aiTextureMapMode_Clamp:
      case aiTextureMapMode_Decal:
        return ImageTexture::Wrap::kClamp;
      case aiTextureMapMode_Mirror:
        return ImageTexture::Wrap::kMirror;
      default:
        return ImageTexture::Wrap::kRepeat;
    }
  }

  absl::StatusOr<TextureId> find_texture(const std::string& file, const TextureStore::Use& use) {
    const auto [embedded, index] = scene_.GetEmbeddedTextureAndIndex(file.c_str());
    if (embedded == nullptr) {
      return external_texture(file, use);
    }
    if (embedded->mHeight != 0) {
      return absl::InvalidArgumentError(
          "its embedded texture is of raw texels, which are not read");
    }
    const std::string name = absl::StrCat(name_of(path_), ", embedded texture ", index);
    return draft_.textures.image(absl::StrCat(path_, "*", index), name, use,
                                 [&texel = *embedded]() -> absl::StatusOr<std::string> {
                                   return std::string(reinterpret_cast<const char*>(texel.pcData),
                                                      texel.mWidth);
                                 });
  }

  absl::StatusOr<TextureId> external_texture(const std::string& file,
                                             const TextureStore::Use& use) {
    const std::string name = absl::StrReplaceAll(file, {{"\\", "/"}});
    const std::string folder = folder_of(path_);
    auto path = draft_.folder.resolve(name, folder);
    if (absl::IsNotFound(path.status()) && percent_decoded(name) != name) {
      path = draft_.folder.resolve(percent_decoded(name), folder);
    }
    if (!path.ok()) {
      return absl::Status(path.status().code(),
                          absl::StrCat("its texture ", path.status().message()));
    }
    return draft_.textures.image(*path, name_of(*path), use,
                                 [&] { return read_whole_file(*path, kMaxImageFileBytes); });
  }

  const aiScene& scene_;
  const aiMaterial& material_;
  const std::string& path_;
  SceneDraft& draft_;
  std::string title_;
};

}  // namespace

absl::StatusOr<ModelMaterial> read_model_material(const aiScene& scene, unsigned index,
                                                  const std::string& model_path,
                                                  SceneDraft& draft) {
  return Reader(scene, index, model_path, draft).read();
}

}  // namespace bandsaw
