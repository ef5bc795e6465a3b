#pragma once

// OpenEXR files, by tinyexr; stb_image does not know them.

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

bool is_exr(absl::string_view bytes);

/// A picture with channels R, G, B, or one channel for all; halves or floats, scan lines or tiles.
/// Alpha is left out. Linear floats, rows from the top, values of any kind, also NaN. The size is
/// checked before anything is decoded. INVALID_ARGUMENT: the reason, without the file's name.
absl::StatusOr<ImageTexture> decode_exr(absl::string_view bytes);

}  // namespace bandsaw
