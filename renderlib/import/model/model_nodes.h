#pragma once

// Converts the tree of nodes of a model to placements, cameras and lights.

#include <assimp/matrix4x4.h>

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_mesh.h"

namespace bandsaw {

/// Returns Assimp's matrix as a Transform. Its last row is not used.
Transform transform_of(const aiMatrix4x4& m);

/// Flattens the tree of nodes. Each mesh of each node becomes an instance; the transforms from the
/// root to the node are multiplied in double. A skinned mesh becomes one instance without a
/// transform, because its bones have placed its vertices. Cameras have the names of their nodes;
/// lights are placed at their nodes. An instance whose transform is singular is omitted with a
/// warning. Returns RESOURCE_EXHAUSTED for more than a million placements.
absl::StatusOr<Model> read_nodes(ModelFile& file, const ModelMeshes& meshes);

}  // namespace bandsaw
