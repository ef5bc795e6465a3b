#pragma once

// Evaluates the tracks of a scene file. A track changes a number of the scene over time.

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Returns a copy of `from` in which each track has set its field to the value at `time`. `root`
/// gives the place of `from` in the file for messages of errors. Returns INVALID_ARGUMENT if a
/// track has a field that does not exist or cannot change, keys that do not increase in time, or a
/// wrong number of values.
absl::StatusOr<scene::Scene> scene_at(const Field& root, const scene::Scene& from, double time);

/// Returns true if a track changes the camera.
bool moves_camera(const scene::Scene& from);

}  // namespace bandsaw
