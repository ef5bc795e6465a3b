#pragma once

// Decodes WebP files with libwebp; stb_image does not support them.

#include <cstdint>
#include <memory>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

/// Returns true if the bytes begin as a WebP file does.
bool is_webp(absl::string_view bytes);

struct WebpHeader {
  int width = 0;
  int height = 0;
  bool has_alpha = false;
};

/// Reads the properties of an image without decoding it. Returns INVALID_ARGUMENT if the image is
/// broken or an animation. The message gives the reason but not the file's name.
absl::StatusOr<WebpHeader> webp_header(absl::string_view bytes);

/// Decodes a lossy or lossless image to 8-bit sRGB: `channels` (3, or 4 with alpha) bytes for each
/// pixel, rows from the top. The size is that of webp_header(). Returns INVALID_ARGUMENT if the
/// image is broken or truncated. The message gives the reason but not the file's name.
absl::StatusOr<std::shared_ptr<std::uint8_t>> decode_webp(absl::string_view bytes, int channels);

}  // namespace bandsaw
