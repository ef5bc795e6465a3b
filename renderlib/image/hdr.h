#pragma once

// Radiance encoder (.hdr): three 8-bit mantissas with a shared exponent, run-length coded. Ward
// 1991, "Real Pixels", Graphics Gems II.5, and the RADIANCE manual's file format notes.

#include <cstddef>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Encodes the image, rows from the top. Each channel is rounded to nearest, within 1/256 of the
/// pixel's largest channel. Values above 1.7e38 become that; negative values and NaN become 0.
std::vector<std::byte> encode_hdr(const Image& image);

}  // namespace bandsaw
