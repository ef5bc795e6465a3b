#pragma once

// Decodes OpenEXR files with tinyexr; stb_image does not support them.

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"
#include "renderlib/texture/texture.h"

namespace bandsaw {

/// Returns true if the bytes begin as an EXR file does.
bool is_exr(absl::string_view bytes);

/// Decodes an image with the channels R, G and B, or with one channel for all three. Its numbers
/// are halves or floats, and its scan lines or tiles are stored in any order. Alpha is omitted. The
/// image is the display window; pixels outside of the data window are black. Returns linear floats,
/// rows from the top, of any value including NaN. The size is checked before anything is decoded.
/// Returns INVALID_ARGUMENT if the file cannot be decoded. The message gives the reason but not the
/// file's name.
absl::StatusOr<ImageTexture> decode_exr(absl::string_view bytes);

}  // namespace bandsaw
