#pragma once

// Evaluates the tracks of a scene file: numbers that change over time.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Returns the scene as it is at a time: a copy in which each track has set its field. `root` is
/// the field of `from`. Returns INVALID_ARGUMENT at a track whose field does not exist, whose keys
/// do not increase in time, or whose numbers do not fit.
absl::StatusOr<scene::Scene> scene_at(const Field& root, const scene::Scene& from, double time);

/// Returns true if a track changes the camera.
bool moves_camera(const scene::Scene& from);

}  // namespace bandsaw
