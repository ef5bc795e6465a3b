#include "renderlib/import/model/gltf_extensions.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "absl/strings/match.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/model/gltf_json.h"
#include "renderlib/import/model/gltf_support.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

using gltf::extension;
using gltf::find;
using gltf::list;
using gltf::ListValue;
using gltf::name_in;
using gltf::number;
using gltf::object;
using gltf::Struct;

// Two numbers, or what stands there.
void read_pair(const Struct& in, const std::string& name, double& x, double& y) {
  const ListValue* values = list(in, name);
  if (values != nullptr && values->values_size() == 2) {
    x = values->values(0).number_value();
    y = values->values(1).number_value();
  }
}

// offset + rotation (scale uv) with the image's top at v = 0, seen from uvs whose v = 0 is the
// bottom: v -> 1 - v before and after. The rotation is counter-clockwise as the image is seen.
UvTransform transform_of(const Struct& from) {
  double offset_u = 0;
  double offset_v = 0;
  double scale_u = 1;
  double scale_v = 1;
  read_pair(from, "offset", offset_u, offset_v);
  read_pair(from, "scale", scale_u, scale_v);
  constexpr double kTurn = 6.283185307179586;
  const SinCos turn = sincos_turns(number(from, "rotation").value_or(0) / kTurn);
  return {{turn.cos * scale_u, -turn.sin * scale_v, offset_u + turn.sin * scale_v,
           turn.sin * scale_u, turn.cos * scale_v, 1 - offset_v - turn.cos * scale_v}};
}

GltfTexture texture_of(const Struct& from) {
  GltfTexture to;
  double uv_set = number(from, "texCoord").value_or(0);
  if (const Struct* placed = extension(from, "KHR_texture_transform"); placed != nullptr) {
    to.transform = transform_of(*placed);
    uv_set = number(*placed, "texCoord").value_or(uv_set);
  }
  const bool finite = std::all_of(to.transform.m.begin(), to.transform.m.end(),
                                  [](double v) { return std::isfinite(v); });
  to.transform = finite ? to.transform : UvTransform{};
  to.uv_set = uv_set >= 0 && uv_set < 64 ? static_cast<unsigned>(uv_set) : 0;
  return to;
}

void read_textures_of(const Struct& from, GltfMaterial& to) {
  for (const auto& [name, value] : from.fields()) {
    if (absl::EndsWith(name, "Texture") && value.has_struct_value()) {
      to.textures[name] = texture_of(value.struct_value());
    }
  }
}

GltfSpecular specular_of(const Struct& from) {
  GltfSpecular to;
  to.factor = number(from, "specularFactor").value_or(1);
  const ListValue* color = list(from, "specularColorFactor");
  for (int i = 0; color != nullptr && color->values_size() == 3 && i < 3; ++i) {
    to.color[static_cast<std::size_t>(i)] = color->values(i).number_value();
  }
  to.has_maps =
      object(from, "specularTexture") != nullptr || object(from, "specularColorTexture") != nullptr;
  return to;
}

GltfMaterial material_of(const Struct& from) {
  GltfMaterial to;
  to.name = name_in(from);
  read_textures_of(from, to);
  if (const Struct* base = object(from, "pbrMetallicRoughness"); base != nullptr) {
    read_textures_of(*base, to);
  }
  for (const char* name : {"KHR_materials_clearcoat", "KHR_materials_transmission",
                           "KHR_materials_pbrSpecularGlossiness"}) {
    if (const Struct* layer = extension(from, name); layer != nullptr) {
      read_textures_of(*layer, to);
    }
  }
  if (const Struct* coat = extension(from, "KHR_materials_clearcoat"); coat != nullptr) {
    const Struct* normal = object(*coat, "clearcoatNormalTexture");
    to.coat_normal_scale = normal == nullptr ? 1 : number(*normal, "scale").value_or(1);
  }
  if (const Struct* glow = extension(from, "KHR_materials_emissive_strength"); glow != nullptr) {
    to.emissive_strength = number(*glow, "emissiveStrength");
  }
  if (const Struct* specular = extension(from, "KHR_materials_specular"); specular != nullptr) {
    to.specular = specular_of(*specular);
  }
  if (const Struct* ior = extension(from, "KHR_materials_ior"); ior != nullptr) {
    to.index_of_refraction = number(*ior, "ior").value_or(1.5);
  }
  to.unlit = extension(from, "KHR_materials_unlit") != nullptr;
  return to;
}

}  // namespace

absl::StatusOr<GltfExtensions> read_gltf_extensions(const std::string& path) {
  GltfExtensions out;
  const std::optional<Struct> root = gltf::root_of(path);
  if (!root) {
    out.unread = true;
    return out;
  }
  RETURN_IF_ERROR(check_gltf_support(*root));
  out.ignored = ignored_extensions(*root);
  GltfLoadOrder order = load_order(*root);
  for (const Struct* material : order.materials) {
    out.materials.push_back(material_of(*material));
  }
  out.cameras = std::move(order.cameras);
  out.lights = std::move(order.lights);
  out.bones = std::move(order.bones);
  if (const ListValue* scenes = list(*root, "scenes"); scenes != nullptr) {
    out.scenes = static_cast<std::size_t>(scenes->values_size());
  }
  const Struct* punctual = extension(*root, "KHR_lights_punctual");
  const ListValue* lights = punctual == nullptr ? nullptr : list(*punctual, "lights");
  for (int i = 0; lights != nullptr && i < lights->values_size(); ++i) {
    out.lights_with_range += find(lights->values(i).struct_value(), "range") != nullptr ? 1 : 0;
  }
  return out;
}

}  // namespace bandsaw
