#pragma once

// The one file that stb_image_write is compiled in.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"

namespace bandsaw {

/// A PNG of 8-bit RGB, rows from the top, width x height x 3 codes. RESOURCE_EXHAUSTED: too large
/// to encode.
absl::StatusOr<std::vector<std::byte>> encode_png(std::uint32_t width, std::uint32_t height,
                                                  absl::Span<const std::uint8_t> codes);

}  // namespace bandsaw
