#pragma once

// glTF's material <-> proto/package.proto.

#include <string>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/material/material.h"

namespace bandsaw {

void encode_principled(const Principled& from, package::Gltf& to);

/// INVALID_ARGUMENT: not of the stated form. Ranges and indices are checked by check_materials.
absl::StatusOr<Principled> decode_principled(const package::Gltf& from, const std::string& field);

}  // namespace bandsaw
