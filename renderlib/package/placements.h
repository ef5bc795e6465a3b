#pragma once

// What is where, and what moves how: instances and frames, to and from a manifest.

#include "absl/status/status.h"
#include "proto/package.pb.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

void encode_placements(const Geometry& geometry, package::Manifest& manifest);

/// Adds them to `geometry`. Form only: check_placements judges the values. INVALID_ARGUMENT: a list
/// of the wrong length.
absl::Status decode_placements(const package::Manifest& manifest, Geometry& geometry);

/// Indices, ranges and finiteness, of a geometry whose other parts have been checked.
absl::Status check_placements(const Geometry& geometry, std::size_t materials);

}  // namespace bandsaw
