#pragma once

// Media in a manifest. Shapes of their boundaries are blobs and come with the others.

#include "absl/status/statusor.h"
#include "proto/package.pb.h"
#include "renderlib/scene/media.h"

namespace bandsaw {

/// All but the shapes of the boundaries.
void encode_media(const Media& media, package::Manifest& manifest);

/// The same back; form only. INVALID_ARGUMENT: a list of the wrong length.
absl::StatusOr<Media> decode_media(const package::Manifest& manifest);

}  // namespace bandsaw
