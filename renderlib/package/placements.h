#pragma once

// What is where, and what moves how: instances and frames, to and from a manifest.

#include <string>

#include "absl/status/status.h"
#include "proto/package.pb.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

using Frames = google::protobuf::RepeatedPtrField<package::Frame>;
using Instances = google::protobuf::RepeatedPtrField<package::Instance>;

void encode_placements(const Geometry& geometry, Frames& frames, Instances& instances);

/// Adds them to `geometry`. Form only: check_placements judges the values. INVALID_ARGUMENT: a list
/// of the wrong length, its name from `prefix` on.
absl::Status decode_placements(const Frames& frames, const Instances& instances,
                               const std::string& prefix, Geometry& geometry);

/// Indices, ranges and finiteness, of a geometry whose other parts have been checked.
absl::Status check_placements(const Geometry& geometry, std::size_t materials);

}  // namespace bandsaw
