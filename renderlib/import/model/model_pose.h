#pragma once

// Computes the pose of a model at a time: where its nodes are, and the vertices of its morph
// targets and skins. Without an animation the model has its rest pose: the morph targets have the
// weights of the file, and each node has the transform that the file gives it.

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "renderlib/import/animation/animation.h"
#include "renderlib/math/float3.h"
#include "renderlib/math/transform.h"

struct aiMesh;
struct aiScene;

namespace bandsaw {

/// A model's nodes at a time: their transforms to the model's space. A node's number is its place
/// in the order of Assimp's tree, parents first.
struct NodePlaces {
  std::vector<Transform> by_number;
  std::map<std::string, std::size_t> by_name;  ///< each name -> number of the first node with it
  std::map<unsigned, std::size_t> of_meshes;   ///< each mesh -> number of the first node with it
};
/// Returns the nodes at `time`, in seconds. If `animation` is nullptr, each node has the transform
/// that the file gives it.
NodePlaces node_places(const aiScene& scene, const Animation* animation, double time);

/// The values on which a mesh's vertices depend.
struct MeshPose {
  std::vector<double> weights =
      {};  ///< weights of the morph targets; if empty, the file's weights are used
  /// Transforms of the mesh's bones to the model's space, in the order of the bones; std::nullopt:
  /// no skin.
  std::optional<std::vector<Transform>> bones = std::nullopt;
  Transform place = {};  ///< transform of the skin's vertices that have no bone
  friend bool operator==(const MeshPose&, const MeshPose&) = default;
};

struct Vertices {
  std::vector<Float3> positions;
  std::vector<Float3> normals;  ///< empty, or one per position
  friend bool operator==(const Vertices&, const Vertices&) = default;
};

/// Returns a mesh's vertices in a pose. Morph targets are added by their weights; a target whose
/// number of vertices differs is omitted. A skin transforms each vertex and its normal to the
/// model's space by the weighted mean of its bones' transforms (linear blend skinning; glTF 2.0,
/// 3.7.3.3).
Vertices posed_vertices(const aiMesh& from, const MeshPose& pose);

}  // namespace bandsaw
