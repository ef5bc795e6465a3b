#pragma once

// Conversion of environments and delta lights to and from messages of proto/package.proto, for
// encode.cpp and decode.cpp.

#include <vector>

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/light/delta_light.h"
#include "renderlib/light/environment.h"

namespace bandsaw {

void encode_environment(const Environment& from, package::Environment& to);
void encode_light(const DeltaLight& from, package::Light& to);

// The decoders check only the form; scene/validate.h checks the values. They return
// INVALID_ARGUMENT for an unknown kind or a list of a wrong length.

/// Decodes the environment of the manifest's background.
absl::StatusOr<Environment> decode_environment(const package::Environment& from);
/// Decodes all delta lights of the manifest.
absl::StatusOr<std::vector<DeltaLight>> decode_lights(const package::Manifest& manifest);

}  // namespace bandsaw
