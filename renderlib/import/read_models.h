#pragma once

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/field.h"
#include "renderlib/import/model.h"
#include "renderlib/import/scene_draft.h"

namespace bandsaw {

/// All model entries of a scene file, placed, and the camera of the first that brings one, in world
/// space. A file that is named twice is read once. The scene's materials have been read.
absl::StatusOr<std::optional<PerspectiveCamera>> read_models(const Field& root,
                                                             const scene::Scene& from,
                                                             SceneDraft& draft);

}  // namespace bandsaw
