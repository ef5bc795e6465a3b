#pragma once

#include <google/protobuf/repeated_field.h>

#include "absl/status/statusor.h"
#include "proto/scene.pb.h"
#include "renderlib/import/scene_file/field.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// Returns the product of the rotations `list`, which are the field `rotate` of `in` (a camera, an
/// environment map or a cube map). They are applied in the order written. An empty list gives the
/// identity. Returns INVALID_ARGUMENT, with the name of the field, if a rotation is invalid.
absl::StatusOr<Transform> read_rotation(
    const Field& in, const google::protobuf::RepeatedPtrField<scene::Rotation>& list);

}  // namespace bandsaw
