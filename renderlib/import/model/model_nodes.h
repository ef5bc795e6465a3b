#pragma once

#include <assimp/matrix4x4.h>

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_mesh.h"

namespace bandsaw {

Transform transform_of(const aiMatrix4x4& m);

/// The tree of nodes, flattened: one instance for each mesh of each node, its transform multiplied
/// in double; a mesh with a skin once, where its bones hold it. Its cameras have the names of their
/// nodes, its lights stand at theirs. A node that flattens its meshes is left out with a warning.
/// RESOURCE_EXHAUSTED: more than a million placements.
absl::StatusOr<Model> read_nodes(ModelFile& file, const ModelMeshes& meshes);

}  // namespace bandsaw
