// Reads numbers and colours of an Assimp material, and finds its textures with their transforms,
// wrap modes and uv sets. For glTF, the JSON's values replace those of Assimp.

#include "renderlib/import/model/material_reader.h"

#include <assimp/GltfMaterial.h>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>
#include <assimp/mesh.h>
#include <assimp/scene.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/math/elementary.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {
namespace {

/// Returns our wrap mode. Assimp's decal mode, without texels outside of the image, becomes kClamp.
ImageTexture::Wrap wrap_of(aiTextureMapMode mode) {
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

/// Returns the transform that scales, rotates around (0.5, 0.5) and translates, as
/// assimp/material.h describes it; the identity if a number is not finite.
UvTransform uv_transform_of(const aiUVTransform& from) {
  const double su = from.mScaling.x;
  const double sv = from.mScaling.y;
  constexpr double kTurn = 6.283185307179586;  // 2 pi
  const double turns = from.mRotation / kTurn;
  if (!std::isfinite(su) || !std::isfinite(sv) || !std::isfinite(turns) ||
      !std::isfinite(from.mTranslation.x) || !std::isfinite(from.mTranslation.y)) {
    return {};
  }
  const SinCos turn = sincos_turns(turns - std::floor(turns));
  const double a = turn.cos * su;
  const double b = -turn.sin * sv;
  const double c = turn.sin * su;
  const double d = turn.cos * sv;
  // Rotation around the middle: R (s uv - m) + m, m = (1/2, 1/2).
  const double mu = 0.5 - 0.5 * (turn.cos - turn.sin);
  const double mv = 0.5 - 0.5 * (turn.sin + turn.cos);
  return {{a, b, mu + from.mTranslation.x, c, d, mv + from.mTranslation.y}};
}

// Returns the name without white space around it: Assimp keeps the white space at the end of a line
// of an MTL file.
std::string without_space(const aiString& name) {
  return std::string(absl::StripAsciiWhitespace(name.C_Str()));
}

/// Returns true if the image is 8-bit and its texels look like encoded directions (0.5 + 0.5 n)
/// that mostly point away from the surface: the means of x and y are near 0, and the mean of z is
/// near 1.
bool looks_like_normals(const ImageTexture& image) {
  if (image.format == ImageTexture::Format::kFloat32 || image.channels != 3) {
    return false;
  }
  const std::size_t texels = image.texels.size() / 3;
  std::array<std::uint64_t, 3> sums{};
  for (std::size_t i = 0; i < 3 * texels; ++i) {
    sums[i % 3] += static_cast<std::uint64_t>(image.texels[i]);
  }
  const auto mean = [&](std::size_t channel) {
    return static_cast<double>(sums[channel]) / (255.0 * static_cast<double>(texels));
  };
  const auto is_about_half = [](double v) { return std::abs(v - 0.5) < 0.1; };
  return is_about_half(mean(0)) && is_about_half(mean(1)) && mean(2) > 0.8;
}

/// Returns glTF's name of the textureInfo that Assimp stores in this slot.
const char* gltf_name(MaterialReader::Slot slot) {
  switch (slot.type) {
    case aiTextureType_BASE_COLOR:
      return "baseColorTexture";
    case aiTextureType_DIFFUSE:
      return "diffuseTexture";
    case aiTextureType_SPECULAR:
      return "specularGlossinessTexture";
    case aiTextureType_UNKNOWN:
      return "metallicRoughnessTexture";
    case aiTextureType_NORMALS:
      return "normalTexture";
    case aiTextureType_EMISSIVE:
      return "emissiveTexture";
    case aiTextureType_TRANSMISSION:
      return "transmissionTexture";
    case aiTextureType_CLEARCOAT:
      return slot.index == 0   ? "clearcoatTexture"
             : slot.index == 1 ? "clearcoatRoughnessTexture"
                               : "clearcoatNormalTexture";
    default:
      return "";
  }
}

}  // namespace

MaterialReader::MaterialReader(ModelFile& file, unsigned index)
    : file_(file),
      index_(index),
      material_(*file.scene.mMaterials[index]),
      textures_(file.scene, file.path, file.draft) {
  aiString name;
  material_.Get(AI_MATKEY_NAME, name);
  called_ = name.length == 0 ? absl::StrCat(index) : absl::StrCat("\"", name.C_Str(), "\"");
  if (kind() == ModelKind::kOther) {
    find_dead_files();
  }
}

// Finds the textures whose files are missing or must not be read. Such a texture is left out with a
// warning. This is called only for formats in which names of missing files are common.
void MaterialReader::find_dead_files() {
  for (unsigned type = aiTextureType_DIFFUSE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
    for (unsigned index = 0; index < material_.GetTextureCount(aiTextureType(type)); ++index) {
      const std::string file = file_of({aiTextureType(type), index});
      const absl::Status found = file.empty() ? absl::OkStatus() : textures_.locate(file);
      const bool dead = absl::IsNotFound(found) || absl::IsPermissionDenied(found);
      if (dead && dead_files_.insert(file).second) {
        unsupported(absl::StrCat(found.message(), "; the material is shown without this texture"));
      }
    }
  }
}

const GltfMaterial* MaterialReader::gltf() const {
  // The materials of the JSON are in Assimp's order. The JSON's material at index_ is right if it
  // has the same name or no name. Otherwise the material is found by its name.
  const std::vector<GltfMaterial>& all = file_.gltf.materials;
  aiString name;
  material_.Get(AI_MATKEY_NAME, name);
  const auto is_this = [&](const GltfMaterial& m) { return m.name == name.C_Str(); };
  if (index_ < all.size() && (all[index_].name.empty() || is_this(all[index_]))) {
    return &all[index_];
  }
  // A material without a name that is not at its index is not in the JSON. An example is Assimp's
  // default material.
  const auto found = name.length == 0 ? all.end() : std::find_if(all.begin(), all.end(), is_this);
  return found == all.end() ? nullptr : &*found;
}

std::optional<double> MaterialReader::number(const char* key, double least, double most) const {
  float value = 0;
  if (material_.Get(key, 0, 0, value) != aiReturn_SUCCESS || !std::isfinite(value)) {
    return std::nullopt;
  }
  return std::clamp(double{value}, least, most);
}

std::optional<Rgb> MaterialReader::color(const char* key, float most) const {
  aiColor4D c;
  if (material_.Get(key, 0, 0, c) != aiReturn_SUCCESS) {
    return std::nullopt;
  }
  const auto channel = [&](float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, most) : 0.0f; };
  return Rgb{channel(c.r), channel(c.g), channel(c.b)};
}

double MaterialReader::alpha_of(const char* key) const {
  aiColor4D c(1, 1, 1, 1);
  material_.Get(key, 0, 0, c);
  return std::isfinite(c.a) ? std::clamp(double{c.a}, 0.0, 1.0) : 1;
}

bool MaterialReader::has_vertex_colors() const {
  const aiScene& scene = file_.scene;
  return std::any_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes, [&](const aiMesh* mesh) {
    return mesh->mMaterialIndex == index_ && mesh->HasVertexColors(0);
  });
}

std::string MaterialReader::name() const {
  aiString name;
  material_.Get(AI_MATKEY_NAME, name);
  return name.C_Str();
}

bool MaterialReader::is_default_of_obj() const {
  // A material of the file may have the same name, so its colour is compared too.
  constexpr float kAssimpGray = 0.6f;
  return kind() == ModelKind::kObj && name() == AI_DEFAULT_MATERIAL_NAME &&
         color("$clr.diffuse", 1) == gray(kAssimpGray);
}

bool MaterialReader::has(Slot slot) const {
  const std::string file = file_of(slot);
  return !file.empty() && dead_files_.count(file) == 0;
}

std::string MaterialReader::file_of(Slot slot) const {
  aiString file;
  return material_.GetTexture(slot.type, slot.index, &file) == aiReturn_SUCCESS ? file.C_Str() : "";
}

UvSet MaterialReader::uv_set_of(unsigned assimp_set) {
  const auto found = std::find(uv_sets_.begin(), uv_sets_.end(), assimp_set);
  if (found == uv_sets_.end() && uv_sets_.size() == 2) {
    unsupported("its third set of uvs is left out: the first is used");
    return UvSet::kFirst;
  }
  const auto place = found - uv_sets_.begin();
  if (found == uv_sets_.end()) {
    uv_sets_.push_back(assimp_set);
  }
  return place == 0 ? UvSet::kFirst : UvSet::kSecond;
}

TextureStore::Use MaterialReader::use_of(Slot slot) {
  TextureStore::Use use;
  aiTextureMapMode modes[2] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
  unsigned uv_set = 0;
  aiString file;
  material_.GetTexture(slot.type, slot.index, &file, nullptr, &uv_set, nullptr, nullptr, modes);
  use.wrap = wrap_of(modes[0]);
  if (modes[0] != modes[1]) {
    use.wrap_v = wrap_of(modes[1]);
  }
  int filter = 0;
  constexpr int kGlNearest = 9728;
  if (material_.Get(AI_MATKEY_GLTF_MAPPINGFILTER_MAG(slot.type, slot.index), filter) ==
          aiReturn_SUCCESS &&
      filter == kGlNearest) {
    use.filter = ImageTexture::Filter::kNearest;
  }
  if (const GltfMaterial* gltf_material = gltf(); gltf_material != nullptr) {
    const auto found = gltf_material->textures.find(gltf_name(slot));
    if (found != gltf_material->textures.end()) {
      uv_set = found->second.uv_set;
      use.uv_transform = found->second.transform;
    }
  } else {
    aiUVTransform transform;
    material_.Get(AI_MATKEY_UVTRANSFORM(slot.type, slot.index), transform);
    use.uv_transform = uv_transform_of(transform);
    const auto& of_mtl = file_.mtl.transforms;
    if (const auto found = of_mtl.find({name(), without_space(file)}); found != of_mtl.end()) {
      use.uv_transform = found->second;
    }
  }
  use.uv_set = uv_set_of(uv_set);
  return use;
}

absl::Status MaterialReader::failed(const absl::Status& why) const {
  return absl::Status(why.code(),
                      absl::StrCat(file_.name(), ": material ", called_, ": ", why.message()));
}

absl::StatusOr<TextureId> MaterialReader::map(Slot slot, As as, const Rgb& factor) {
  if (!has(slot)) {
    return white();
  }
  TextureStore::Use use = use_of(slot);
  use.linear = as != As::kColor;
  use.alpha = as == As::kAlpha;
  use.factor = factor;
  use.alpha_is_known = kind() == ModelKind::kGltf;
  return find(slot, use);
}

absl::StatusOr<TextureId> MaterialReader::find(Slot slot, const TextureStore::Use& use) {
  auto texture = textures_.find(file_of(slot), use);
  return texture.ok() ? texture : failed(texture.status());
}

absl::StatusOr<TextureId> MaterialReader::bump_map(Slot slot) {
  TextureStore::Use use = use_of(slot);
  use.linear = true;
  use.become = TextureStore::Use::Become::kNormals;
  // File formats define no unit of heights. The unit here is one texel, which keeps bumps visible
  // and shallow.
  float strength = 1;
  material_.Get(AI_MATKEY_OBJ_BUMPMULT(slot.type, slot.index), strength);
  use.by = std::isfinite(strength) ? std::clamp(double{strength}, -1e6, 1e6) : 1;
  return find(slot, use);
}

absl::StatusOr<TextureId> MaterialReader::index_map(Slot slot, double index) {
  TextureStore::Use use = use_of(slot);
  use.become = TextureStore::Use::Become::kIndexMap;
  use.by = index;
  return find(slot, use);
}

absl::StatusOr<TextureId> MaterialReader::opacity_map(Slot slot) {
  const std::string file = file_of(slot);
  const auto see_through = textures_.is_see_through(file);
  const bool is_color =
      file == file_of({aiTextureType_DIFFUSE}) || file == file_of({aiTextureType_BASE_COLOR});
  TextureStore::Use use = use_of(slot);
  use.linear = true;
  use.alpha = is_color || (see_through.ok() && *see_through);
  use.alpha_is_known = true;
  return find(slot, use);
}

bool MaterialReader::holds_normals(Slot slot) const {
  const auto image = textures_.decoded(file_of(slot));
  return image.ok() && looks_like_normals(*image);
}

ModelMaterial MaterialReader::add(const Material& material) const {
  ModelMaterial to;
  to.id = file_.draft.add_material(material);
  to.uv_set = uv_sets_.empty() ? 0 : uv_sets_[0];
  to.second_uv_set = uv_sets_.size() < 2 ? kNoUvSet : uv_sets_[1];
  return to;
}

}  // namespace bandsaw
