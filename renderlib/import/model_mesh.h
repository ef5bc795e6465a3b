#pragma once

#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/model_material.h"

namespace bandsaw {

struct ModelMesh {
  MeshId mesh{};
  MaterialId material{};
};

/// By Assimp's number; nothing where a mesh has no triangle that can be rendered.
using ModelMeshes = std::vector<std::optional<ModelMesh>>;

/// Adds the meshes to the draft: triangles only, and none with a vertex that is not finite (a
/// warning tells how many). Normals and uvs that are not finite are mended. INVALID_ARGUMENT: an
/// index is out of range.
absl::StatusOr<ModelMeshes> add_meshes(const aiScene& scene,
                                       const std::vector<ModelMaterial>& materials,
                                       const std::string& model_name, SceneDraft& draft);

}  // namespace bandsaw
