#pragma once

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {

struct ModelMesh {
  MeshId mesh{};
  MaterialId material{};
  bool skinned = false;  ///< its vertices stand in the model's own space, whatever node bears it
};

/// By Assimp's number; nothing where a mesh has no triangle that can be rendered.
using ModelMeshes = std::vector<std::optional<ModelMesh>>;

/// Adds the meshes to the draft, in their rest pose: triangles only, and none with a vertex that is
/// not finite (a warning tells how many). Normals, uvs and colours that are not finite are
/// repaired. Vertex colours come with the materials of the file alone. INVALID_ARGUMENT: an index
/// is out of range.
absl::StatusOr<ModelMeshes> add_meshes(ModelFile& file, const std::vector<ModelMaterial>& materials,
                                       bool with_colors);

}  // namespace bandsaw
