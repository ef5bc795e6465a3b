#pragma once

// Whether an image is off on the whole, and not only noisy: noise has no sign, a bias has one.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Blocks of 16 by 16 pixels, those at the right and lower edge smaller. The values are the mean
/// differences in luminance of half rows: every other pixel of a block's row. Their noise is
/// independent, which that of single pixels is not: those of one half row may have found their
/// light together (render/tile_samples.h). Each block gives its mean and Student's t of it from
/// their spread; the reference's own noise is part of the spread. Blocks of fewer than 8 values are
/// left out.
struct BiasTest {
  std::uint32_t blocks = 0;
  /// t of the whole: the mean over all values by its standard error. |t| above 4 is no chance.
  double t = 0;
  double relative_bias = 0;  ///< of the sums over pixels; 0 where the reference is black
  /// Blocks with |t| above what one of so many passes by chance once in a hundred images (Sidak; of
  /// normal noise).
  std::uint32_t suspicious_blocks = 0;
  double worst_t = 0;         ///< of the block with the largest |t|
  std::uint32_t worst_x = 0;  ///< its first pixel
  std::uint32_t worst_y = 0;
};

inline constexpr std::uint32_t kBiasBlock = 16;

/// The images MUST be of one size.
BiasTest test_bias(const Image& image, const Image& reference);

}  // namespace bandsaw
