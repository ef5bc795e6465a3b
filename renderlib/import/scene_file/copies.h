#pragma once

#include <vector>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// How each copy of an instance is moved: one at least.
absl::StatusOr<std::vector<Transform>> read_copies(const Field& in, const scene::Instance& from);

}  // namespace bandsaw
