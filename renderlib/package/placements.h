#pragma once

// Conversion of instances, and of the frames (moving coordinate systems) in which they are placed,
// to and from a manifest (proto/package.proto).

#include <string>

#include "absl/status/status.h"
#include "proto/package.pb.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

using Frames = google::protobuf::RepeatedPtrField<package::Frame>;
using Instances = google::protobuf::RepeatedPtrField<package::Instance>;

void encode_placements(const Geometry& geometry, Frames& frames, Instances& instances);

/// Appends the frames and instances to `geometry`. Checks only the form; scene/validate.h checks
/// the values. Returns INVALID_ARGUMENT if a list has a wrong length. In the message, `prefix`
/// stands before the name of the list's field.
absl::Status decode_placements(const Frames& frames, const Instances& instances,
                               const std::string& prefix, Geometry& geometry);

}  // namespace bandsaw
