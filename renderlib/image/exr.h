#pragma once

// OpenEXR pictures, by tinyexr.

#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"
#include "renderlib/image/layers.h"

namespace bandsaw {

/// Scan lines from the top, channels R, G, B and those of the layers, ZIP compressed. Floats are
/// exact; halves are to the nearest, cut off at +-65504. INVALID_ARGUMENT: a layer of another size.
/// RESOURCE_EXHAUSTED: too large to encode.
absl::StatusOr<std::vector<std::byte>> encode_exr(const Image& image, bool half,
                                                  const Layers& layers = {});

/// Numbers of the image that halves cut off.
std::uint64_t beyond_half(const Image& image);

}  // namespace bandsaw
