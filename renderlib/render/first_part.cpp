// A film divides the samples of each pixel into two parts of about equal size, and offers the image
// of the first part by itself. From the images of the two parts, the denoiser learns how noisy the
// image is. The division is by nodes of the summation tree (ranges of 2^k blocks of samples). An
// image that is read from a file has no nodes. For such an image, the number of samples in the
// first part is computed here from the number of a pixel's samples alone.

#include "renderlib/render/first_part.h"

#include <algorithm>
#include <bit>

#include "renderlib/render/band.h"

namespace bandsaw {
namespace {

/// Returns the share of a pixel's `samples` samples that is in the first part.
float share_of(std::uint64_t samples) {
  return static_cast<float>(static_cast<double>(first_part_samples(samples)) /
                            static_cast<double>(samples));
}

}  // namespace

std::uint64_t first_part_samples(std::uint64_t samples) {
  if (samples <= kBlockSamples) {
    return 0;
  }
  // A complete film (strip_nodes.cpp) stores the two halves of the largest whole node that begins
  // at sample 0. After them, it stores the largest nodes that fit.
  const std::uint64_t whole = std::bit_floor(samples / kBlockSamples) * kBlockSamples;
  std::uint64_t first = whole;
  std::uint64_t second = 0;
  if (whole > kBlockSamples) {
    first = second = whole / 2;
  }
  for (std::uint64_t at = whole; at < samples;) {
    const std::uint64_t blocks = std::bit_floor(SampleRange{at, samples}.blocks());
    const std::uint64_t last = std::min(at + blocks * kBlockSamples, samples);
    // A further node goes to the smaller part. If both parts are equal, it goes to the first part.
    (first > second ? second : first) += last - at;
    at = last;
  }
  return first;
}

std::vector<float> first_part_shares(std::uint64_t samples, std::size_t pixels) {
  return std::vector<float>(pixels, share_of(samples));
}

std::vector<float> first_part_shares(const Image& counts) {
  std::vector<float> shares;
  shares.reserve(counts.pixels.size());
  for (const Rgb& count : counts.pixels) {
    shares.push_back(share_of(static_cast<std::uint64_t>(count.r)));
  }
  return shares;
}

}  // namespace bandsaw
