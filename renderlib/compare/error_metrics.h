#pragma once

// How far an image is from a reference, number by number.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Over all channels of all pixels where both values are finite; a is the image, b the reference,
/// linear RGB.
struct ErrorMetrics {
  double rmse = 0;           ///< sqrt(mean((a - b)^2))
  double relative_rmse = 0;  ///< rmse / mean(b); 0 where both are black, infinite where only b is
  double relative_mse =
      0;  ///< mean((a - b)^2 / (b^2 + 0.01)), as Rousselle et al. 2011, "Adaptive Sampling and
          ///< Reconstruction using Greedy Error Minimization", section 5
  double trimmed_relative_mse = 0;  ///< the same without the worst 0.1 % of the pixels, rounded up
  double mape = 0;                  ///< mean(|a - b| / (|b| + 0.01))
  double psnr =
      0;  ///< decibels, of the sRGB-coded values in [0, 1]; infinite where those are equal
  double max_difference = 0;  ///< largest |a - b|
  std::uint32_t max_x = 0;    ///< where that is, the first such
  std::uint32_t max_y = 0;
  std::uint64_t not_finite = 0;  ///< channel values left out
  bool identical = false;        ///< every value is equal, and finite
};

/// The images MUST be of one size and not empty.
ErrorMetrics error_metrics(const Image& image, const Image& reference);

}  // namespace bandsaw
