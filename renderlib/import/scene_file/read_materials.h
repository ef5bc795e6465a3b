#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads all materials of a scene file with their textures into the scene, and their names into
/// SceneDraft::materials. Returns INVALID_ARGUMENT, with the name of the field, if a field is
/// invalid.
absl::Status read_materials(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// Returns the material with this name, which is the value of `in`'s field "material". Returns
/// INVALID_ARGUMENT if there is none.
absl::StatusOr<MaterialId> find_material(const Field& in, const std::string& name,
                                         const SceneDraft& draft);

}  // namespace bandsaw
