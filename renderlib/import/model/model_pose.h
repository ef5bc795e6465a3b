#pragma once

// Poses of a model at a time: its nodes, morph targets and skins. Without an animation this is the
// rest pose: initial weights, and every bone at its node.

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "renderlib/geometry/shapes.h"
#include "renderlib/import/animation/animation.h"
#include "renderlib/math/transform.h"

struct aiMesh;
struct aiScene;

namespace bandsaw {

/// A model's nodes at a time: transforms in the model's space, by number (parents first).
struct NodePlaces {
  std::vector<Transform> by_number;
  std::map<std::string, std::size_t> by_name;  ///< if several share a name, the first
  std::map<unsigned, std::size_t> of_meshes;   ///< the first node of each mesh
};
/// `animation` may be nullptr.
NodePlaces node_places(const aiScene& scene, const Animation* animation, double time);

/// Applies the morph targets whose weight is not 0 to vertices and normals (empty, or one a
/// vertex). `weights`: of the targets, or empty for those of the file.
void add_morph_targets(const aiMesh& from, const std::vector<double>& weights, Mesh& mesh);

/// Transforms vertices and normals into the model's space, each by the weighted mean of its bones'
/// transforms (linear blend skinning; glTF 2.0, 3.7.3.3); vertices without a bone by `place`.
/// `bones` are the transforms of the mesh's bones, in their order.
void add_skin(const aiMesh& from, const std::vector<Transform>& bones, const Transform& place,
              Mesh& mesh);

}  // namespace bandsaw
