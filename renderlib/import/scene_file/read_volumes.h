#pragma once

// Reads the grids of a medium from volume files. A grid holds numbers that vary in space: density,
// albedo, emission or temperature.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/draft/scene_draft.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the grids of the medium `from`, whose place is `in`, and adds them to the grids of the
/// scene. A grid that several media use with the same settings is added once.
absl::StatusOr<MediumGrids> read_grids(const Field& in, const scene::Medium& from,
                                       SceneDraft& draft);

}  // namespace bandsaw
