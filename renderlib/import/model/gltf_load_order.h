#pragma once

// Computes the order in which Assimp 5.2 loads the objects of a glTF file. The place in this order
// shows which object of Assimp's result belongs to which object of the JSON. Names cannot show
// this, because they may be missing or shared.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderlib/import/gltf/gltf_json.h"

namespace bandsaw {

/// A camera or light at a node. Assimp stores only one node for each camera and each light, even if
/// several nodes share it.
struct GltfAtNode {
  std::size_t node = 0;    ///< index of the node in Assimp's tree, parents first
  std::size_t loaded = 0;  ///< index among the objects of its kind, in Assimp's order
  std::string name;        ///< of the camera or light, not of the node; may be empty
  /// The vertical field of view of a perspective camera, in radians. Assimp passes on a horizontal
  /// field of view, which its versions compute in different ways.
  std::optional<double> vertical_fov;
};

/// Load order of the default scene: nodes depth first, each after its children.
struct GltfLoadOrder {
  std::vector<const gltf::Json*> materials;
  std::vector<GltfAtNode> cameras;
  std::vector<GltfAtNode> lights;  ///< KHR_lights_punctual
  /// The nodes of each mesh's bones, as GltfAtNode::node, keyed by Assimp's mesh number. A mesh
  /// without a skin is absent. A mesh with a bone outside the scene has an empty list.
  std::map<std::size_t, std::vector<std::size_t>> bones;
  /// GltfAtNode::node of each node of the scene, keyed by its index in the file.
  std::map<std::size_t, std::size_t> nodes;
};

/// Returns the load order of the default scene of the JSON `root`. The result contains pointers
/// into `root`.
GltfLoadOrder load_order(const gltf::Json& root);

}  // namespace bandsaw
