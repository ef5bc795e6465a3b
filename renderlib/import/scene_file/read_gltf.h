#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the material of kind `gltf` of `in`, with its alpha, emission and normal map.
absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft);

}  // namespace bandsaw
