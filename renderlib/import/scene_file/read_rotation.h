#pragma once

#include <google/protobuf/repeated_field.h>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// Reads the rotations of the field `rotate` of `in`, a camera or a background, applied in the
/// order written; the identity if there are none. Returns INVALID_ARGUMENT with the field's name.
absl::StatusOr<Transform> read_rotation(
    const Field& in, const google::protobuf::RepeatedPtrField<scene::Rotation>& list);

}  // namespace bandsaw
