#pragma once

// OpenEXR encoder, using tinyexr.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw {

/// Encodes scan lines from the top, ZIP compressed; the channels are R, G, B and those of `layers`.
/// If `half` is true, all channels except those of layers with `is_number` are stored as halves,
/// rounded to nearest and clamped to +-65504. All other channels are exact floats. Returns
/// INVALID_ARGUMENT if a layer has another number of pixels than the image or a name of more than
/// 200 bytes, and RESOURCE_EXHAUSTED if the image is too large to encode.
absl::StatusOr<std::vector<std::byte>> encode_exr(const Image& image, bool half,
                                                  const Layers& layers = {});

/// Returns the number of channel values that halves would clamp.
std::uint64_t beyond_half(const Image& image);

}  // namespace bandsaw
