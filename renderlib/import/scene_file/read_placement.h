#pragma once

// Reads placements of a scene file: scale, then rotate, then translate, once or at several times.

#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/geometry/frame.h"
#include "renderlib/import/scene_file/field.h"

namespace bandsaw {

/// Reads the placement of `in`: a Model, an Instance, a Copy or a Key.
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Model& from);
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Instance& from);
absl::StatusOr<Transform> read_placement(const Field& in, const scene::Copy& from);

/// Reads the keys of a Model or an Instance, its placements at increasing times; empty if it has
/// none. All functions return INVALID_ARGUMENT with the field's name.
absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Model& from);
absl::StatusOr<std::vector<Key>> read_keys(const Field& in, const scene::Instance& from);

}  // namespace bandsaw
