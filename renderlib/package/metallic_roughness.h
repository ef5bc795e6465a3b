#pragma once

// Conversion of glTF's material to and from proto/package.proto.

#include <string>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/material/material.h"

namespace bandsaw {

void encode_metallic_roughness(const MetallicRoughness& from, package::Gltf& to);

/// Decodes a material, which error messages call `field`. Checks only the form; scene/validate.h
/// checks the values. Returns INVALID_ARGUMENT for a list of a wrong length.
absl::StatusOr<MetallicRoughness> decode_metallic_roughness(const package::Gltf& from,
                                                            const std::string& field);

}  // namespace bandsaw
