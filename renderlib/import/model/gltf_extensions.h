#pragma once

// The parts of a glTF file that Assimp 5.2 does not pass on: which extensions it uses, how its
// textures are placed, how strong its emission is, at which nodes cameras stand, how many scenes it
// holds. They are read from the file's JSON.

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

/// A textureInfo of a material, by what it is of: "baseColorTexture", "clearcoatNormalTexture".
struct GltfTexture {
  unsigned uv_set = 0;
  UvTransform transform;  ///< KHR_texture_transform, for uvs whose v = 0 is the bottom row
};

/// KHR_materials_specular: how much of the index's reflection along the normal is there.
struct GltfSpecular {
  double factor = 1;
  std::array<double, 3> color{1, 1, 1};
  bool has_maps = false;
};

/// KHR_materials_volume: what is inside of the mesh.
struct GltfVolume {
  double thickness = 0;  ///< 0: the mesh is a thin pane
  /// The length after which white light has the colour; infinite: nothing is absorbed.
  double attenuation_distance = std::numeric_limits<double>::infinity();
  std::array<double, 3> attenuation_color{1, 1, 1};
};

struct GltfMaterial {
  std::string name;
  std::optional<GltfVolume> volume;
  std::vector<std::string>
      unsupported;  ///< as UnsupportedFeatures: what it has that nothing here shows
  std::map<std::string, GltfTexture> textures;
  std::optional<double> emissive_strength;    ///< KHR_materials_emissive_strength
  std::optional<double> index_of_refraction;  ///< KHR_materials_ior
  std::optional<GltfSpecular> specular;
  double coat_normal_scale = 1;  ///< of KHR_materials_clearcoat
  bool unlit = false;            ///< KHR_materials_unlit
};

struct GltfExtensions {
  std::vector<std::string> ignored;  ///< extensions that the file uses and that change nothing here
  /// Those that the scene uses, in the order in which Assimp meets them: nodes depth first, each
  /// after its children. None of glTF 1.
  std::vector<GltfMaterial> materials;
  std::vector<GltfAtNode> cameras;                        ///< of the default scene; none of glTF 1
  std::vector<GltfAtNode> lights;                         ///< likewise
  std::map<std::size_t, std::vector<std::size_t>> bones;  ///< as GltfLoadOrder's
  std::size_t scenes = 1;
  std::size_t animations = 0;
  std::size_t lights_with_range = 0;  ///< KHR_lights_punctual: a hint to cut light off
};

/// `root` is that of a plain glTF file: its references have been checked.
GltfExtensions read_gltf_extensions(const gltf::Json& root);

}  // namespace bandsaw
