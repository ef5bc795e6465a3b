#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/field.h"
#include "renderlib/import/scene_draft.h"

namespace bandsaw {

/// A material of kind `gltf`, which `in` stands for.
absl::StatusOr<Material> read_gltf(const Field& in, const scene::Gltf& from, SceneDraft& draft);

}  // namespace bandsaw
