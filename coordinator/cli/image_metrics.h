#pragma once

// How far an image is from a reference.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/image/image.h"

namespace bandsaw::coordinator {

/// Over all channels of all pixels where both values are finite; a is the image, b the reference,
/// linear RGB.
struct ImageMetrics {
  double rmse = 0;           ///< sqrt(mean((a - b)^2))
  double relative_rmse = 0;  ///< rmse / mean(b); 0 where both are black, infinite where only b is
  double relative_mse =
      0;  ///< mean((a - b)^2 / (b^2 + 0.01)), as Rousselle et al. 2011, "Adaptive Sampling and
          ///< Reconstruction using Greedy Error Minimization", section 5
  double max_difference = 0;  ///< largest |a - b|
  std::uint32_t max_x = 0;    ///< where that is, the first such
  std::uint32_t max_y = 0;
  std::uint64_t not_finite = 0;  ///< channel values left out
  bool identical = false;        ///< every value is equal, and finite
};

/// INVALID_ARGUMENT: the sizes differ.
absl::StatusOr<ImageMetrics> compare_images(const Image& image, const Image& reference);

/// "RMSE 0.0123 · relRMSE 1.6 % · relMSE 0.00031 · max difference 0.5 at pixel (3, 4)", or
/// "identical".
std::string metrics_text(const ImageMetrics& metrics);

}  // namespace bandsaw::coordinator
