#pragma once

// Reads from a glTF file's JSON what Assimp 5.2 does not pass on: used extensions, transforms of
// textures, strength of emission, nodes of cameras, number of scenes. The functions that convert
// materials and nodes (model_*.cpp) combine these values with Assimp's result.

#include <array>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderlib/import/gltf/gltf_json.h"
#include "renderlib/import/model/gltf_load_order.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// A textureInfo of a material: how the material uses a texture.
struct GltfTexture {
  unsigned uv_set = 0;
  UvTransform transform;  ///< KHR_texture_transform, for uvs whose v = 0 is the bottom row
};

/// KHR_materials_specular: scales the reflectance at normal incidence (F0) that follows from the
/// index of refraction.
struct GltfSpecular {
  double factor = 1;
  std::array<double, 3> color{1, 1, 1};  ///< linear RGB, scales F0 too
  bool has_maps = false;
};

/// KHR_materials_volume: the inside of the mesh.
struct GltfVolume {
  double thickness = 0;  ///< 0 for a thin pane
  /// Distance after which white light has `attenuation_color`; infinite if nothing is absorbed.
  double attenuation_distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> attenuation_color{1, 1, 1};
};

struct GltfMaterial {
  std::string name;
  std::optional<GltfVolume> volume;
  std::vector<std::string>
      unsupported;  ///< warnings of features that are not rendered: "its sheen is left out"
  /// Keyed by the member's name in the JSON: "baseColorTexture", "clearcoatNormalTexture".
  std::map<std::string, GltfTexture> textures;
  std::optional<double> emissive_strength;    ///< KHR_materials_emissive_strength
  std::optional<double> index_of_refraction;  ///< KHR_materials_ior
  std::optional<GltfSpecular> specular;
  double coat_normal_scale = 1;  ///< KHR_materials_clearcoat: scale of clearcoatNormalTexture
  bool unlit = false;            ///< KHR_materials_unlit
  bool has_metallic_roughness = false;  ///< pbrMetallicRoughness has a member
};

struct GltfExtensions {
  std::vector<std::string> ignored;  ///< used extensions without effect
  /// Materials that the scene uses, in the order in which Assimp visits them: nodes depth first,
  /// each after its children. Empty for glTF 1.
  std::vector<GltfMaterial> materials;
  std::vector<GltfAtNode> cameras;  ///< cameras of the default scene; empty for glTF 1
  std::vector<GltfAtNode> lights;   ///< lights of the default scene; empty for glTF 1
  /// Assimp's number of a mesh -> Assimp's numbers of its bones' nodes (GltfLoadOrder::bones).
  std::map<std::size_t, std::vector<std::size_t>> bones;
  std::size_t scenes = 1;
  /// Index of a node in the file -> Assimp's number of the node.
  std::map<std::size_t, std::size_t> nodes;
  std::size_t lights_with_range = 0;  ///< lights with KHR_lights_punctual's range, which is ignored
};

/// Reads the JSON of a file. `root` is PlainGltf::root (gltf/plain_gltf.h). For glTF 2 it is the
/// JSON of the rewritten file, whose references have been checked. The JSON of a glTF 1 file is
/// neither rewritten nor checked.
GltfExtensions read_gltf_extensions(const gltf::Json& root);

}  // namespace bandsaw
