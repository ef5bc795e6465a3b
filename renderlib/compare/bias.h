#pragma once

// Statistical test of whether an image differs from a reference by more than noise. Differences
// that noise causes have random signs. Differences that a bias causes have one sign.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Result of the test. Blocks are the tiles of 16 x 16 pixels (render/tile_samples.h). The pixels
/// of a block are divided into groups (render/pixel_groups.h). Pixels of one group may share paths,
/// so only the noise of different groups is independent. Each group gives one value: the mean
/// difference in luminance between the image and the reference. Student's t of a block is the mean
/// of the block's values, divided by the standard error of this mean. The standard error is
/// computed from the spread of the values, so it includes the noise of the reference. Blocks of
/// fewer than 8 values are left out.
struct BiasTest {
  std::uint32_t blocks = 0;
  /// t of the whole image: the mean over all values divided by its standard error. |t| above 4 is
  /// significant.
  double t = 0;
  /// Sum of the differences in luminance to the reference, divided by the sum of the reference's
  /// luminance; 0 if the reference is black.
  double relative_bias = 0;
  /// Number of blocks whose |t| exceeds a bound. The bound is so high that, if the noise is normal,
  /// only one in a hundred unbiased images has a block with a larger |t| (Sidak's correction).
  std::uint32_t suspicious_blocks = 0;
  double worst_t = 0;         ///< t of the block with the largest |t|
  std::uint32_t worst_x = 0;  ///< first pixel of that block
  std::uint32_t worst_y = 0;
};

/// Tests the image against the reference. The images MUST have the same size.
BiasTest test_bias(const Image& image, const Image& reference);

}  // namespace bandsaw
