#pragma once

// Morph targets and skins, as the file leaves them: at the weights it starts with and with every
// bone where its node stands.

#include <map>
#include <string>
#include <vector>

#include "renderlib/geometry/shapes.h"
#include "renderlib/math/transform.h"

struct aiMesh;
struct aiScene;

namespace bandsaw {

/// Where the nodes of a model stand, in the model's own space.
struct NodePlaces {
  std::vector<Transform> by_number;          ///< parents first
  std::map<std::string, Transform> by_name;  ///< of several the first
  std::map<unsigned, Transform> of_meshes;   ///< the first node that bears each
};
NodePlaces node_places(const aiScene& scene);

/// Moves vertices and normals (empty, or one a vertex) by the targets whose weight is not 0.
void add_morph_targets(const aiMesh& from, Mesh& mesh);

/// Moves vertices and normals to where the bones hold them, in the model's own space: each by the
/// weighted mean of its bones' transforms (linear blend skinning; glTF 2.0, 3.7.3.3); vertices
/// without a bone as a whole by `place`. `bones`: where those of the mesh stand, in its order.
void add_skin(const aiMesh& from, const std::vector<Transform>& bones, const Transform& place,
              Mesh& mesh);

}  // namespace bandsaw
