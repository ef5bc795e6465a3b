#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Adds the scene file's delta lights (directional, point, spot, projector) to the scene. Returns
/// INVALID_ARGUMENT, with the name of the field, if a field is invalid.
absl::Status read_lights(const Field& root, const scene::Scene& from, SceneDraft& draft);

}  // namespace bandsaw
