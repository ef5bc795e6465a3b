#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads a material of kind `gltf` of a scene file: glTF's metallic-roughness material with alpha,
/// emission and normal map. `in` is the place of the message `from`. Returns INVALID_ARGUMENT, with
/// the name of the field, if a field is invalid.
absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft);

}  // namespace bandsaw
