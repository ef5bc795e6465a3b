#pragma once

// Morph targets and skins in the rest pose: with the initial weights, and every bone at its node.

#include <map>
#include <string>
#include <vector>

#include "renderlib/geometry/shapes.h"
#include "renderlib/math/transform.h"

struct aiMesh;
struct aiScene;

namespace bandsaw {

/// Transforms of a model's nodes, in the model's space.
struct NodePlaces {
  std::vector<Transform> by_number;          ///< parents first
  std::map<std::string, Transform> by_name;  ///< if several share a name, the first
  std::map<unsigned, Transform> of_meshes;   ///< the first node of each mesh
};
NodePlaces node_places(const aiScene& scene);

/// Applies the morph targets whose weight is not 0 to the vertices and to the normals, if there
/// are any.
void add_morph_targets(const aiMesh& from, Mesh& mesh);

/// Transforms vertices and normals into the model's space, each by the weighted mean of its bones'
/// transforms (linear blend skinning; glTF 2.0, 3.7.3.3); vertices without a bone by `place`.
/// `bones` are the transforms of the mesh's bones, in their order.
void add_skin(const aiMesh& from, const std::vector<Transform>& bones, const Transform& place,
              Mesh& mesh);

}  // namespace bandsaw
