#pragma once

// Converts the meshes of a model, in their poses at the imported time.

#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/import/model/model_file.h"
#include "renderlib/import/model/model_material.h"

namespace bandsaw {

/// A mesh that was added to the draft (ModelFile::draft, the scene while it is being read), with
/// its material.
struct ModelMesh {
  MeshId mesh{};
  MaterialId material{};
  bool skinned = false;  ///< the vertices are in the model's space, not in the node's space
};

/// Indexed by Assimp's number of the mesh; absent for meshes without a triangle that can be
/// rendered.
using ModelMeshes = std::vector<std::optional<ModelMesh>>;

/// Adds the triangles of the meshes to the draft. `materials` have Assimp's order. A mesh whose
/// pose changes while the shutter is open gets the vertices at both ends of the shutter interval.
/// Triangles with a vertex that is not finite are omitted (a warning counts them); normals, uvs and
/// colours that are not finite are repaired. Vertex colours are read only if `with_colors` is true.
/// Returns INVALID_ARGUMENT if an index is out of range.
absl::StatusOr<ModelMeshes> add_meshes(ModelFile& file, const std::vector<ModelMaterial>& materials,
                                       bool with_colors);

}  // namespace bandsaw
