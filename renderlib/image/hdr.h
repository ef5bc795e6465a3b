#pragma once

// Radiance pictures (.hdr): three 8-bit mantissas that share an exponent, run-length coded. Ward
// 1991, "Real pixels", Graphics Gems II.5, and the RADIANCE manual's file format notes.

#include <cstddef>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Each channel is within 1/256 of the pixel's largest, to the nearest; up to 1.7e38. Negative and
/// NaN: 0. Rows from the top.
std::vector<std::byte> encode_hdr(const Image& image);

}  // namespace bandsaw
