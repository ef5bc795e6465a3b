#include "renderlib/import/model/gltf_support.h"

#include <algorithm>
#include <iterator>

#include "absl/strings/string_view.h"

namespace bandsaw {
namespace {

/// Extensions whose meaning reaches the scene, or that say nothing about how it looks.
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
    // Left out; each material that has something of them says so.
    "KHR_materials_sheen",
    "KHR_materials_iridescence",
    "KHR_materials_anisotropy",
    "KHR_materials_dispersion",
    "KHR_materials_diffuse_transmission",
};

}  // namespace

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

}  // namespace bandsaw
