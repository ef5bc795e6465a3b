#pragma once

// OpenEXR pictures, by tinyexr.

#include <cstddef>
#include <vector>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Scan lines from the top, channels R, G, B, ZIP compressed. Floats are exact; halves are to the
/// nearest, cut off at +-65504. RESOURCE_EXHAUSTED: too large to encode.
absl::StatusOr<std::vector<std::byte>> encode_exr(const Image& image, bool half);

}  // namespace bandsaw
