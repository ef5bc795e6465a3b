#pragma once

// A film divides the samples of each pixel into two parts, and the denoiser compares the images of
// the two parts. This file computes how many samples the first part (Film::first_part()) has, for
// images that are read from files.

#include <cstdint>
#include <vector>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns how many of a pixel's `samples` samples are in its first part: about half of them. If
/// there is no more than one block of 8 samples, there are no parts, and the result is 0.
std::uint64_t first_part_samples(std::uint64_t samples);

/// Returns a list of `pixels` numbers, like Film::FirstPart::share: for each pixel the share of its
/// samples that are in the first part, in (0, 1). `samples` is the number of samples of each pixel;
/// it is more than one block.
std::vector<float> first_part_shares(std::uint64_t samples, std::size_t pixels);
/// Does the same for an image that holds the number of samples of each pixel (Film::counts). Each
/// number is more than one block.
std::vector<float> first_part_shares(const Image& counts);

}  // namespace bandsaw
