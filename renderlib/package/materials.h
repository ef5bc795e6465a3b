#pragma once

// Conversion of materials to and from proto/package.proto.

#include <string>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/material/material.h"

namespace bandsaw {

void encode_material(const Material& from, package::Material& to);

/// Decodes a material, which error messages call `field`. Checks only the form; scene/validate.h
/// checks the values. Returns INVALID_ARGUMENT for an unknown kind, an unknown mode or a list of a
/// wrong length.
absl::StatusOr<Material> decode_material(const package::Material& from, const std::string& field);

}  // namespace bandsaw
