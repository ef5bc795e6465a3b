#pragma once

// Converts the tree of nodes of a model to placements, cameras and lights.

#include <assimp/matrix4x4.h>

#include "renderlib/import/model/model.h"
#include "renderlib/import/model/model_mesh.h"

namespace bandsaw {

/// Returns Assimp's matrix as a Transform, which drops the last row of the matrix.
Transform transform_of(const aiMatrix4x4& m);

/// Flattens the tree of nodes. Each mesh of each node becomes an instance, whose placement is the
/// product, in double, of the transforms from the root or the nearest moving node to this node. A
/// skinned mesh becomes one instance without a transform, because its bones have placed its
/// vertices. Cameras have the names of their nodes; lights are placed at their nodes. An instance
/// whose transform is singular is omitted with a warning. Returns RESOURCE_EXHAUSTED for more than
/// a million placements.
absl::StatusOr<Model> read_nodes(ModelFile& file, const ModelMeshes& meshes);

}  // namespace bandsaw
