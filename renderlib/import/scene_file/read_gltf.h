#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the material of kind `gltf` of a scene file, glTF's metallic-roughness material, with its
/// alpha, emission and normal map. `in` is its message. Returns INVALID_ARGUMENT with the field's
/// name.
absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft);

}  // namespace bandsaw
