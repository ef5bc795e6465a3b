#pragma once

// WebP files, by libwebp; stb_image does not know them.

#include <cstdint>
#include <memory>

#include "absl/status/statusor.h"
#include "absl/strings/string_view.h"

namespace bandsaw {

bool is_webp(absl::string_view bytes);

struct WebpHeader {
  int width = 0;
  int height = 0;
  bool has_alpha = false;
};

/// Decodes nothing. INVALID_ARGUMENT: broken, or an animation; the reason, without the file's name.
absl::StatusOr<WebpHeader> webp_header(absl::string_view bytes);

/// 8-bit sRGB, lossy or lossless: `channels` (3, or 4 with alpha) bytes a pixel, rows from the top.
/// INVALID_ARGUMENT: broken or truncated; the reason, without the file's name.
absl::StatusOr<std::shared_ptr<std::uint8_t>> decode_webp(absl::string_view bytes, int channels);

}  // namespace bandsaw
