#pragma once

#include "renderlib/import/model.h"
#include "renderlib/import/model_mesh.h"

namespace bandsaw {

/// The tree of nodes, flattened: one instance for each mesh of each node, its transform multiplied
/// in double. The first perspective camera. A node that flattens its meshes is left out with a
/// warning. RESOURCE_EXHAUSTED: more than a million placements.
absl::StatusOr<Model> read_nodes(const aiScene& scene, const ModelMeshes& meshes,
                                 const std::string& model_name, std::vector<std::string>& warnings);

}  // namespace bandsaw
