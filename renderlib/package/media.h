#pragma once

// Conversion of media to and from a manifest (proto/package.proto). A boundary is a closed shape
// that a medium fills, and a grid states how media vary in space. The shapes of boundaries and the
// numbers of grids are blobs (flat arrays outside of the manifest). encode.cpp and decode.cpp
// convert the blobs.

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/scene/media.h"

namespace bandsaw {

/// Encodes everything except the shapes of the boundaries and the blobs of grids.
void encode_media(const Media& media, package::Manifest& manifest);

/// Decodes what encode_media() encodes. Checks only the form; returns INVALID_ARGUMENT for a list
/// of a wrong length or an enum out of range.
absl::StatusOr<Media> decode_media(const package::Manifest& manifest);

}  // namespace bandsaw
