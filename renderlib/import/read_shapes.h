#pragma once

#include "absl/status/status.h"
#include "proto/scene.pb.h"
#include "renderlib/import/field.h"
#include "renderlib/import/scene_draft.h"

namespace bandsaw {

/// All shapes of a scene file; its materials have been read.
absl::Status read_shapes(const Field& root, const scene::Scene& from, SceneDraft& draft);

}  // namespace bandsaw
