#pragma once

// In which order Assimp 5.2 loads what a glTF file holds: by that its objects are told apart where
// names are not given, or given twice.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw {

/// A camera or a light at a node: Assimp knows but one node of each.
struct GltfAtNode {
  std::size_t node = 0;    ///< the how manieth of Assimp's tree, parents first
  std::size_t loaded = 0;  ///< the how manieth of its kind that Assimp loads
  std::string name;        ///< its own, beside its node's; may be empty
};

/// Of the default scene: nodes depth first, each after its children.
struct GltfLoadOrder {
  std::vector<const gltf::Json*> materials;
  std::vector<GltfAtNode> cameras;
  std::vector<GltfAtNode> lights;  ///< of KHR_lights_punctual
  /// By the numbers of Assimp's meshes: the nodes of the bones, as GltfAtNode::node; none of a mesh
  /// without a skin, or of one with a bone outside the scene.
  std::map<std::size_t, std::vector<std::size_t>> bones;
};

/// Points into `root`.
GltfLoadOrder load_order(const gltf::Json& root);

}  // namespace bandsaw
