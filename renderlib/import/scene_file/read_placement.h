#pragma once

// Reads placements of a scene file. A placement is scale, then rotate, then translate, or a matrix.
// A moving object has keys, which are placements at several times.

#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/geometry/frame.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the placement of `in`, which is a Model, an Instance or a Copy. All functions in this file
/// return INVALID_ARGUMENT, with the name of the field, if a field is invalid.
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Model& from);
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Instance& from);
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Copy& from);

/// Reads the keys of a Model or an Instance, which are its placements at increasing times. Returns
/// an empty list if it has no keys.
absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Model& from);
absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Instance& from);

}  // namespace bandsaw
