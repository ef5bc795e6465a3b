// Reads metallic-roughness materials of glTF, of MTL files with the PBR extension, and of FBX files
// by Maya and 3ds Max.

#include <assimp/GltfMaterial.h>

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/draft/color_limits.h"
#include "renderlib/import/model/material_reader.h"
#include "renderlib/import/model/model_glass.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {
namespace {

using As = MaterialReader::As;
using Slot = MaterialReader::Slot;
constexpr float kMaxRadiance = 1e30f;

/// Returns `first` if the material has that texture, and `second` otherwise.
Slot either(const MaterialReader& reader, Slot first, Slot second) {
  return reader.has(first) ? first : second;
}

/// Returns true if a glTF material is described by pbrMetallicRoughness. Such a material may also
/// have KHR_materials_pbrSpecularGlossiness, whose values Assimp stores as diffuse colour and
/// texture.
bool has_own_base(const MaterialReader& reader) {
  return reader.gltf() != nullptr && reader.gltf()->has_metallic_roughness;
}

/// Returns the slot of the texture of the base colour. A material that is not described by
/// pbrMetallicRoughness may have a diffuse texture instead.
Slot base_slot(const MaterialReader& reader) {
  const Slot base{aiTextureType_BASE_COLOR};
  return has_own_base(reader) ? base : either(reader, base, {aiTextureType_DIFFUSE});
}

// Reads base colour, metallic share and roughness.
absl::Status read_base(MaterialReader& reader, MetallicRoughness& to) {
  const Slot slot = base_slot(reader);
  ASSIGN_OR_RETURN(to.base_color.texture, reader.map(slot, As::kColor));
  const auto base = reader.color("$clr.base", 1);
  to.base_color.factor = base ? *base : reader.color("$clr.diffuse", 1).value_or(Rgb{1, 1, 1});
  // glTF stores metallic and roughness in one image; other formats have an image for each.
  const Slot both{aiTextureType_UNKNOWN};
  const bool shared = reader.kind() == ModelKind::kGltf && reader.has(both);
  const Slot metal = shared ? both : Slot{aiTextureType_METALNESS};
  const Slot rough = shared ? both : Slot{aiTextureType_DIFFUSE_ROUGHNESS};
  ASSIGN_OR_RETURN(to.metallic.texture, reader.map(metal, As::kNumber));
  ASSIGN_OR_RETURN(to.roughness.texture, reader.map(rough, As::kNumber));
  const bool gltf = reader.kind() == ModelKind::kGltf;
  to.metallic.factor =
      reader.number("$mat.metallicFactor", 0, 1).value_or(gltf || reader.has(metal) ? 1 : 0);
  to.roughness.factor = reader.number("$mat.roughnessFactor", 0, 1).value_or(1);
  return absl::OkStatus();
}

// Reads the emitted radiance. Materials of glTF emit on one side unless they are two-sided.
absl::Status read_emission(MaterialReader& reader, Emission& to) {
  const Slot slot = either(reader, {aiTextureType_EMISSIVE}, {aiTextureType_EMISSION_COLOR});
  ASSIGN_OR_RETURN(to.radiance.texture, reader.map(slot, As::kColor));
  const double strength =
      reader.gltf() != nullptr && reader.gltf()->emissive_strength
          ? *reader.gltf()->emissive_strength
          : reader.number("$mat.emissiveIntensity", 0, double{kMaxRadiance}).value_or(1);
  const Rgb color = reader.color("$clr.emissive", kMaxRadiance).value_or(Rgb{}) *
                    static_cast<float>(std::clamp(strength, 0.0, 1e8));  // 1e30 * 1e8 is finite
  const auto bounded = [](float v) { return std::min(v, kMaxRadiance); };
  to.radiance.factor = {bounded(color.r), bounded(color.g), bounded(color.b)};
  int two_sided = reader.kind() == ModelKind::kGltf ? 0 : 1;
  reader.material().Get(AI_MATKEY_TWOSIDED, two_sided);
  to.one_sided = two_sided == 0;
  return absl::OkStatus();
}

// Reads the normal maps of the surface and of its clear coat.
absl::Status read_normals(MaterialReader& reader, Relief& relief, MetallicRoughness& to) {
  const Slot slot = either(reader, {aiTextureType_NORMALS}, {aiTextureType_NORMAL_CAMERA});
  if (reader.has(slot)) {
    ASSIGN_OR_RETURN(relief.normal, reader.map(slot, As::kNumber));
    float scale = 1;
    reader.material().Get(AI_MATKEY_GLTF_TEXTURE_SCALE(slot.type, slot.index), scale);
    relief.normal_scale = std::isfinite(scale) ? scale : 1;
  }
  const Slot coat{aiTextureType_CLEARCOAT, 2};
  if (reader.has(coat)) {
    ASSIGN_OR_RETURN(to.coat_normal, reader.map(coat, As::kNumber));
    const double scale = reader.gltf() != nullptr ? reader.gltf()->coat_normal_scale : 1;
    to.coat_normal_scale = std::isfinite(scale) ? scale : 1;
  }
  return absl::OkStatus();
}

// Sets the index whose F0 is the material's F0 times the specular factor and the luminance of the
// specular colour; the index is at most 5. At grazing angles all light is still reflected, unless
// F0 is 0.
void read_specular(const GltfSpecular& from, MaterialReader& reader, MetallicRoughness& to) {
  const auto [r, g, b] = from.color;
  if (r != g || g != b) {
    reader.unsupported("its specular colour is taken as grey");
  }
  if (from.has_maps) {
    reader.unsupported("its specular map is left out");
  }
  const double amount = from.factor * (0.2126 * r + 0.7152 * g + 0.0722 * b);
  const double root = (to.index_of_refraction - 1) / (to.index_of_refraction + 1);
  // The square root of F0 for an index of 5, the maximum.
  constexpr double kMaxRoot = 4.0 / 6;
  const double f = std::clamp(root * std::sqrt(std::max(0.0, amount)), 0.0, kMaxRoot);
  to.index_of_refraction = std::clamp((1 + f) / (1 - f), 1.0, 5.0);
}

/// Returns the index of refraction without the effect of KHR_materials_specular.
double index_of_refraction(const MaterialReader& reader) {
  if (const GltfMaterial* gltf = reader.gltf(); gltf != nullptr && gltf->index_of_refraction) {
    const double index = *gltf->index_of_refraction;
    // KHR_materials_ior: 0 means a reflection that does not depend on the angle. Such a material
    // gets the index 1.5.
    return index >= 1 && index <= 5 ? index : 1.5;
  }
  return reader.number("$mat.refracti", 1, 5).value_or(1.5);
}

// Reads the index of refraction, the clear coat and the transmission.
absl::Status read_layers(MaterialReader& reader, MetallicRoughness& to) {
  to.index_of_refraction = index_of_refraction(reader);
  if (const GltfMaterial* gltf = reader.gltf(); gltf != nullptr && gltf->specular) {
    read_specular(*gltf->specular, reader, to);
  }
  to.coat.factor = reader.number("$mat.clearcoat.factor", 0, 1).value_or(0);
  to.coat_roughness.factor = reader.number("$mat.clearcoat.roughnessFactor", 0, 1).value_or(0);
  to.transmission.factor = reader.number("$mat.transmission.factor", 0, 1).value_or(0);
  ASSIGN_OR_RETURN(to.coat.texture, reader.map({aiTextureType_CLEARCOAT, 0}, As::kNumber));
  ASSIGN_OR_RETURN(to.coat_roughness.texture,
                   reader.map({aiTextureType_CLEARCOAT, 1}, As::kNumber));
  ASSIGN_OR_RETURN(to.transmission.texture, reader.map({aiTextureType_TRANSMISSION}, As::kNumber));
  return absl::OkStatus();
}

// Converts KHR_materials_pbrSpecularGlossiness without the specular-glossiness image. If the
// surface has no diffuse texture and its specular colour is brighter than 0.5, it is taken as a
// metal. The metallic share m is chosen so that the mixture (1 - m) 0.04 + m is as bright as the
// specular colour.
void from_glossiness(MaterialReader& reader, double glossiness, MetallicRoughness& to) {
  to.roughness.factor = 1 - glossiness;
  to.metallic.factor = 0;
  const Rgb diffuse = reader.color("$clr.diffuse", 1).value_or(Rgb{1, 1, 1});
  const Rgb specular = reader.color("$clr.specular", 1).value_or(Rgb{1, 1, 1});
  to.base_color.factor = diffuse;
  if (reader.has({aiTextureType_SPECULAR})) {
    reader.unsupported(
        "its specular-glossiness map is left out; the material is taken as not metallic");
    return;
  }
  constexpr double kDielectric = 0.04;
  const double bright = std::max({specular.r, specular.g, specular.b});
  if (bright > 0.5 && !reader.has({aiTextureType_DIFFUSE})) {
    to.metallic.factor = std::min(1.0, (bright - kDielectric) / (1 - kDielectric));
    to.base_color.factor = lerp(diffuse, specular, static_cast<float>(to.metallic.factor));
  }
  reader.unsupported("its specular colour and glossiness are taken as metallic and roughness");
}

}  // namespace

absl::Status read_alpha(MaterialReader& reader, Alpha& to) {
  ASSIGN_OR_RETURN(to.value.texture, reader.white());
  const Slot opacity{aiTextureType_OPACITY};
  if (reader.kind() != ModelKind::kGltf) {
    to.value.factor = reader.number("$mat.opacity", 0, 1).value_or(1);
    if (reader.has(opacity)) {
      ASSIGN_OR_RETURN(to.value.texture, reader.opacity_map(opacity));
    }
    const bool whole = to.value.factor == 1 && !reader.has(opacity);
    to.mode = whole ? AlphaMode::kOpaque : AlphaMode::kBlend;
    return absl::OkStatus();
  }
  aiString mode;
  reader.material().Get(AI_MATKEY_GLTF_ALPHAMODE, mode);
  const absl::string_view name = mode.C_Str();
  if (name != "MASK" && name != "BLEND") {
    return absl::OkStatus();
  }
  to.mode = name == "MASK" ? AlphaMode::kMask : AlphaMode::kBlend;
  to.cutoff = reader.number("$mat.gltf.alphaCutoff", 0, 1e30).value_or(0.5);
  to.value.factor = reader.alpha_of(has_own_base(reader) ? "$clr.base" : "$clr.diffuse");
  ASSIGN_OR_RETURN(to.value.texture, reader.map(base_slot(reader), As::kAlpha));
  return absl::OkStatus();
}

absl::StatusOr<ModelMaterial> read_metallic_roughness(MaterialReader& reader) {
  MetallicRoughness layers;
  Material to;
  RETURN_IF_ERROR(read_base(reader, layers));
  RETURN_IF_ERROR(read_emission(reader, to.emission));
  RETURN_IF_ERROR(read_normals(reader, to.relief, layers));
  RETURN_IF_ERROR(read_alpha(reader, to.alpha));
  RETURN_IF_ERROR(read_layers(reader, layers));
  if (const auto glossiness = reader.number("$mat.glossinessFactor", 0, 1);
      glossiness && reader.kind() == ModelKind::kGltf && !has_own_base(reader)) {
    from_glossiness(reader, *glossiness, layers);
  }
  to.kind = layers;
  ModelMaterial added = reader.add(to);
  added.glass = glass_of(reader, to, index_of_refraction(reader));
  return added;
}

}  // namespace bandsaw
