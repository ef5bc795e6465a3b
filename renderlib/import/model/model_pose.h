#pragma once

// Morph targets and skins, as the file leaves them: at the weights it starts with and with every
// bone where its node stands.

#include <map>
#include <string>

#include "renderlib/geometry/shapes.h"
#include "renderlib/math/transform.h"

struct aiMesh;
struct aiScene;

namespace bandsaw {

/// Where the nodes of a model stand, by name, in the model's own space.
std::map<std::string, Transform> node_places(const aiScene& scene);

/// Moves vertices and normals (empty, or one a vertex) by the targets whose weight is not 0.
void add_morph_targets(const aiMesh& from, Mesh& mesh);

enum class Skin { kNone, kApplied, kIncomplete };

/// Moves vertices and normals to where the bones hold them, in the model's own space: each by the
/// weighted mean of its bones' transforms (linear blend skinning; glTF 2.0, 3.7.3.3); vertices
/// without a bone as a whole by `place`. kIncomplete: a bone has no node; nothing was moved.
Skin add_skin(const aiMesh& from, const std::map<std::string, Transform>& places,
              const Transform& place, Mesh& mesh);

}  // namespace bandsaw
