#pragma once

// Reads the grids of media of a scene file.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the grids of a medium, the message of `in`, which are added to the scene's. A file that is
/// used several times in the same place is added once.
absl::StatusOr<MediumGrids> read_grids(const Field& in, const scene::Medium& from,
                                       SceneDraft& draft);

}  // namespace bandsaw
