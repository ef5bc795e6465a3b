#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Adds the written lights to the scene. INVALID_ARGUMENT: a field.
absl::Status read_lights(const Field& root, const scene::Scene& from, SceneDraft& draft);

}  // namespace bandsaw
