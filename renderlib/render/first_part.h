#pragma once

// The number of samples in Film::first_part(), for images that are read from files.

#include <cstdint>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns how many of a pixel's samples are in its first part, about half of them; 0 if it has a
/// single block of samples or less, which has no parts.
std::uint64_t first_part_samples(std::uint64_t samples);

/// Returns the share of the first part in the samples of each of `pixels` pixels, (0, 1), as
/// Film::first_part() does. `samples` is the number of each pixel, more than one block.
std::vector<float> first_part_shares(std::uint64_t samples, std::size_t pixels);
/// The same for an image of the number of samples of each pixel (Film::counts), each more than one
/// block.
std::vector<float> first_part_shares(const Image& counts);

}  // namespace bandsaw
