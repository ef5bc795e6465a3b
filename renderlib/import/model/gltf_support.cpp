#include "renderlib/import/model/gltf_support.h"

#include <algorithm>
#include <iterator>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/string_view.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw {
namespace {

using gltf::ListValue;
using gltf::Struct;
using gltf::Value;

/// Extensions whose meaning reaches the scene, or that say nothing about how it looks.
constexpr absl::string_view kKnown[] = {
    "KHR_materials_clearcoat",    "KHR_materials_emissive_strength",
    "KHR_materials_ior",          "KHR_materials_specular",
    "KHR_materials_transmission", "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_unlit",        "KHR_texture_transform",
    "KHR_lights_punctual",        "KHR_xmp_json_ld",
    "KHR_draco_mesh_compression"};

/// Extensions that put other bytes in the place of vertices or pictures. Without others something
/// looks other than it was meant, which is a warning.
constexpr absl::string_view kUnreadable[] = {"EXT_meshopt_compression", "KHR_meshopt_compression",
                                             "KHR_texture_basisu",      "EXT_texture_webp",
                                             "EXT_texture_avif",        "MSFT_texture_dds"};

constexpr char kCure[] = "; gltf-transform (dequantize, copy, ktxdecompress) writes it without";
constexpr int kGlFloat = 5126;

bool is_known(const std::string& name) {
  return std::find(std::begin(kKnown), std::end(kKnown), name) != std::end(kKnown);
}

std::vector<std::string> names_in(const Struct& root, const std::string& list_name) {
  std::vector<std::string> names;
  if (const ListValue* found = gltf::list(root, list_name)) {
    for (const Value& name : found->values()) {
      names.push_back(name.string_value());
    }
  }
  return names;
}

// Assimp reads colours, joints and indices of every type.
bool is_read_as_floats(absl::string_view attribute) {
  return attribute == "POSITION" || attribute == "NORMAL" || attribute == "TANGENT" ||
         absl::StartsWith(attribute, "TEXCOORD_") || absl::StartsWith(attribute, "WEIGHTS_");
}

absl::Status check_attributes(const Struct& root, const Struct& attributes) {
  for (const auto& [name, index] : attributes.fields()) {
    const Struct* accessor = gltf::item(root, "accessors", index.number_value());
    if (is_read_as_floats(name) && accessor != nullptr &&
        gltf::number(*accessor, "componentType").value_or(kGlFloat) != kGlFloat) {
      return absl::InvalidArgumentError(
          absl::StrCat("its ", name, " are integers, only floats are read", kCure));
    }
  }
  return absl::OkStatus();
}

absl::Status check_mesh(const Struct& root, const Struct& mesh) {
  const ListValue* primitives = gltf::list(mesh, "primitives");
  for (int i = 0; primitives != nullptr && i < primitives->values_size(); ++i) {
    const Struct& primitive = primitives->values(i).struct_value();
    if (const Struct* attributes = gltf::object(primitive, "attributes")) {
      RETURN_IF_ERROR(check_attributes(root, *attributes));
    }
    const ListValue* targets = gltf::list(primitive, "targets");
    for (int t = 0; targets != nullptr && t < targets->values_size(); ++t) {
      RETURN_IF_ERROR(check_attributes(root, targets->values(t).struct_value()));
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::vector<std::string> ignored_extensions(const Struct& root) {
  std::vector<std::string> names = names_in(root, "extensionsUsed");
  names.erase(std::remove_if(names.begin(), names.end(), is_known), names.end());
  return names;
}

absl::Status check_gltf_support(const Struct& root) {
  for (const std::string& name : names_in(root, "extensionsRequired")) {
    if (std::find(std::begin(kUnreadable), std::end(kUnreadable), name) != std::end(kUnreadable)) {
      return absl::InvalidArgumentError(
          absl::StrCat("it requires the extension ", name, ", which is not read", kCure));
    }
  }
  const ListValue* meshes = gltf::list(root, "meshes");
  for (int i = 0; meshes != nullptr && i < meshes->values_size(); ++i) {
    RETURN_IF_ERROR(check_mesh(root, meshes->values(i).struct_value()));
  }
  return absl::OkStatus();
}

}  // namespace bandsaw
