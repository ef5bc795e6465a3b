#pragma once

// Conversion of glTF's material to and from proto/package.proto.

#include <string>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/material/material.h"

namespace bandsaw {

void encode_principled(const Principled& from, package::Gltf& to);

/// Checks only the form, not the values (scene/validate.h). Returns INVALID_ARGUMENT for a list of
/// a wrong length.
absl::StatusOr<Principled> decode_principled(const package::Gltf& from, const std::string& field);

}  // namespace bandsaw
