#pragma once

// PNG encoder, using stb_image_write.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

/// Encodes a PNG of 8-bit RGB, rows from the top; `codes` has width x height x 3 values. Returns
/// RESOURCE_EXHAUSTED if the image is too large to encode.
absl::StatusOr<std::vector<std::byte>> encode_png(std::uint32_t width, std::uint32_t height,
                                                  absl::Span<const std::uint8_t> codes);

}  // namespace bandsaw
