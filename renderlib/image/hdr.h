#pragma once

// Encoder of the image format of the program Radiance (.hdr). A pixel is three 8-bit mantissas with
// a shared exponent, and rows are run-length coded. The format is described in Ward 1991, "Real
// Pixels", Graphics Gems II.5, and in the RADIANCE manual's file format notes.

#include <cstddef>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Encodes the image, rows from the top. Each channel is rounded to nearest. The error is at most
/// 1/256 of the pixel's largest channel. Values above 1.7e38 become 1.7e38; negative values and NaN
/// become 0.
std::vector<std::byte> encode_hdr(const Image& image);

}  // namespace bandsaw
