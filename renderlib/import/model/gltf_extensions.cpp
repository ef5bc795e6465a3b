// Reads those parts of a glTF file's JSON that Assimp does not pass on. Most of them are extensions
// of materials. The materials have the order in which Assimp loads them (gltf_load_order.h).

#include "renderlib/import/model/gltf_extensions.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/match.h"
#include "absl/strings/string_view.h"
#include "renderlib/import/gltf/gltf_json.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Extensions that are supported, or that do not affect the image.
constexpr absl::string_view kKnown[] = {
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_volume",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_xmp_json_ld",
    "KHR_draco_mesh_compression",
    "KHR_mesh_quantization",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    // Not rendered; each material that uses one adds a warning.
    "KHR_materials_sheen",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
};

/// Returns the extensions that the file uses and that are not in kKnown. They have no effect.
std::vector<std::string> ignored_extensions(const gltf::Json& root) {
  std::vector<std::string> names;
  for (const gltf::Json& used : gltf::items(root, "extensionsUsed")) {
    const std::string name = used.is_string() ? used.get<std::string>() : "";
    if (!name.empty() &&
        std::find(std::begin(kKnown), std::end(kKnown), name) == std::end(kKnown)) {
      names.push_back(name);
    }
  }
  return names;
}

using gltf::extension;
using gltf::find;
using gltf::items;
using gltf::Json;
using gltf::list;
using gltf::name_in;
using gltf::number;
using gltf::object;

// Reads two numbers. If the member is not a list of two numbers, `x` and `y` keep their values.
void read_pair(const Json& in, const std::string& name, double& x, double& y) {
  const Json* values = list(in, name);
  if (values != nullptr && values->size() == 2 && (*values)[0].is_number() &&
      (*values)[1].is_number()) {
    x = (*values)[0].get<double>();
    y = (*values)[1].get<double>();
  }
}

// Converts the transform offset + rotation (scale uv) of KHR_texture_transform. In this transform
// v = 0 is the top of the image; in the result v = 0 is the bottom. So v is replaced by 1 - v
// before and after the transform. The rotation is counter-clockwise in the image.
UvTransform transform_of(const Json& from) {
  double offset_u = 0;
  double offset_v = 0;
  double scale_u = 1;
  double scale_v = 1;
  read_pair(from, "offset", offset_u, offset_v);
  read_pair(from, "scale", scale_u, scale_v);
  constexpr double kTurn = 6.283185307179586;  // 2 pi
  const SinCos turn = sincos_turns(number(from, "rotation").value_or(0) / kTurn);
  return {{turn.cos * scale_u, -turn.sin * scale_v, offset_u + turn.sin * scale_v,
           turn.sin * scale_u, turn.cos * scale_v, 1 - offset_v - turn.cos * scale_v}};
}

// Reads a textureInfo. A transform that is not finite becomes the identity.
GltfTexture texture_of(const Json& from) {
  GltfTexture to;
  double uv_set = number(from, "texCoord").value_or(0);
  if (const Json* placed = extension(from, "KHR_texture_transform"); placed != nullptr) {
    to.transform = transform_of(*placed);
    uv_set = number(*placed, "texCoord").value_or(uv_set);
  }
  const bool finite = std::all_of(to.transform.m.begin(), to.transform.m.end(),
                                  [](double v) { return std::isfinite(v); });
  to.transform = finite ? to.transform : UvTransform{};
  // Assimp stores fewer than 64 sets; the limit keeps the conversion to an integer defined.
  to.uv_set = uv_set >= 0 && uv_set < 64 ? static_cast<unsigned>(uv_set) : 0;
  return to;
}

// Reads all textureInfos that are members of `from`.
void read_textures_of(const Json& from, GltfMaterial& to) {
  for (const auto& [name, value] : from.items()) {
    if (absl::EndsWith(name, "Texture") && value.is_object()) {
      to.textures[name] = texture_of(value);
    }
  }
}

/// Reads an array of three numbers. Returns `otherwise` if there is no such array. An element that
/// is not a number is replaced by the element of `otherwise`.
std::array<double, 3> triple_of(const Json& in, const std::string& name,
                                std::array<double, 3> otherwise) {
  const Json* values = list(in, name);
  for (std::size_t i = 0; values != nullptr && values->size() == 3 && i < 3; ++i) {
    otherwise[i] = (*values)[i].is_number() ? (*values)[i].get<double>() : otherwise[i];
  }
  return otherwise;
}

/// Reads the extension KHR_materials_specular.
GltfSpecular specular_of(const Json& from) {
  GltfSpecular to;
  to.factor = number(from, "specularFactor").value_or(1);
  to.color = triple_of(from, "specularColorFactor", {1, 1, 1});
  to.has_maps =
      object(from, "specularTexture") != nullptr || object(from, "specularColorTexture") != nullptr;
  return to;
}

/// Reads KHR_materials_volume of a material; std::nullopt if the material has no volume.
std::optional<GltfVolume> volume_of(const Json& material) {
  const Json* from = extension(material, "KHR_materials_volume");
  if (from == nullptr) {
    return std::nullopt;
  }
  GltfVolume to;
  to.thickness = number(*from, "thicknessFactor").value_or(0);
  to.attenuation_distance = number(*from, "attenuationDistance").value_or(to.attenuation_distance);
  to.attenuation_color = triple_of(*from, "attenuationColor", {1, 1, 1});
  return to;
}

/// Returns the features of a material's extensions that are not rendered, as texts of warnings.
std::vector<std::string> unsupported_features_of(const Json& material) {
  std::vector<std::string> out;
  const auto has = [&](const char* name, const char* factor) {
    const Json* from = extension(material, name);
    return from != nullptr && number(*from, factor).value_or(0) != 0;
  };
  const Json* sheen = extension(material, "KHR_materials_sheen");
  if (sheen != nullptr &&
      triple_of(*sheen, "sheenColorFactor", {0, 0, 0}) != std::array<double, 3>{0, 0, 0}) {
    out.emplace_back("its sheen is left out");
  }
  if (has("KHR_materials_iridescence", "iridescenceFactor")) {
    out.emplace_back("its iridescence is left out");
  }
  if (has("KHR_materials_anisotropy", "anisotropyStrength")) {
    out.emplace_back("its anisotropy is left out: it shines alike in all directions");
  }
  if (has("KHR_materials_dispersion", "dispersion")) {
    out.emplace_back("its dispersion is left out: all colours are refracted alike");
  }
  if (has("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor")) {
    out.emplace_back("its diffuse transmission is left out");
  }
  return out;
}

/// Reads a material of the JSON.
GltfMaterial material_of(const Json& from) {
  GltfMaterial to;
  to.name = name_in(from);
  read_textures_of(from, to);
  if (const Json* base = object(from, "pbrMetallicRoughness"); base != nullptr) {
    read_textures_of(*base, to);
    to.has_metallic_roughness = !base->empty();
  }
  for (const char* name : {"KHR_materials_clearcoat", "KHR_materials_transmission",
                           "KHR_materials_pbrSpecularGlossiness"}) {
    if (const Json* layer = extension(from, name); layer != nullptr) {
      read_textures_of(*layer, to);
    }
  }
  if (const Json* coat = extension(from, "KHR_materials_clearcoat"); coat != nullptr) {
    const Json* normal = object(*coat, "clearcoatNormalTexture");
    to.coat_normal_scale = normal == nullptr ? 1 : number(*normal, "scale").value_or(1);
  }
  if (const Json* glow = extension(from, "KHR_materials_emissive_strength"); glow != nullptr) {
    to.emissive_strength = number(*glow, "emissiveStrength");
  }
  if (const Json* specular = extension(from, "KHR_materials_specular"); specular != nullptr) {
    to.specular = specular_of(*specular);
  }
  if (const Json* ior = extension(from, "KHR_materials_ior"); ior != nullptr) {
    to.index_of_refraction = number(*ior, "ior").value_or(1.5);
  }
  to.volume = volume_of(from);
  to.unsupported = unsupported_features_of(from);
  to.unlit = extension(from, "KHR_materials_unlit") != nullptr;
  return to;
}

}  // namespace

GltfExtensions read_gltf_extensions(const Json& root) {
  GltfExtensions out;
  out.ignored = ignored_extensions(root);
  GltfLoadOrder order = load_order(root);
  for (const Json* material : order.materials) {
    out.materials.push_back(material_of(*material));
  }
  out.cameras = std::move(order.cameras);
  out.lights = std::move(order.lights);
  out.bones = std::move(order.bones);
  out.nodes = std::move(order.nodes);
  out.scenes = std::max<std::size_t>(1, items(root, "scenes").size());
  const Json* punctual = extension(root, "KHR_lights_punctual");
  if (punctual != nullptr) {
    for (const Json& light : items(*punctual, "lights")) {
      out.lights_with_range += find(light, "range") != nullptr ? 1 : 0;
    }
  }
  return out;
}

}  // namespace bandsaw
