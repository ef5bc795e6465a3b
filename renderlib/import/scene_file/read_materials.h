#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// All materials of a scene file with their textures.
absl::Status read_materials(const Field& root, const scene::Scene& from, SceneDraft& draft);

/// The material called `name`, which is the value of `in`'s field "material". INVALID_ARGUMENT:
/// none is called so.
absl::StatusOr<MaterialId> find_material(const Field& in, const std::string& name,
                                         const SceneDraft& draft);

}  // namespace bandsaw
