#pragma once

// Portable float maps, the exact pictures that renderlib/image writes; stb_image does not know
// them.

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/image/image.h"

namespace bandsaw {

bool is_pfm(absl::string_view bytes);

/// "PF" (or "Pf", expanded), width, height, scale (its sign is the byte order), then rows from the
/// bottom. Values of any kind, also NaN: it is a measurement, not a colour of a scene.
/// INVALID_ARGUMENT: broken or truncated.
absl::StatusOr<Image> decode_pfm(absl::string_view bytes);

}  // namespace bandsaw
