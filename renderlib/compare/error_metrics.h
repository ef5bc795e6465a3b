#pragma once

// Pixel-wise error metrics of an image against a reference.

#include <cstdint>

#include "renderlib/image/image.h"

namespace bandsaw {

/// Metrics over all channel values that are finite in both images. In the formulas, a is a value of
/// the image and b is the value of the reference, in linear RGB. If no value is finite in both
/// images, the metrics from rmse to psnr are NaN.
struct ErrorMetrics {
  double rmse = 0;  ///< sqrt(mean((a - b)^2))
  /// rmse / |mean(b)|; 0 if rmse is 0, otherwise infinite if mean(b) is 0.
  double relative_rmse = 0;
  /// mean((a - b)^2 / (b^2 + 0.01)), as in Rousselle et al. 2011, "Adaptive Sampling and
  /// Reconstruction using Greedy Error Minimization", section 5.
  double relative_mse = 0;
  /// `relative_mse` without the worst 0.1 % of the pixels; their number is rounded up.
  double trimmed_relative_mse = 0;
  double mape = 0;  ///< mean(|a - b| / (|b| + 0.01))
  /// Decibels, of the sRGB-coded values in [0, 1]; infinite if these values are equal.
  double psnr = 0;
  double max_difference = 0;  ///< largest |a - b|
  std::uint32_t max_x = 0;    ///< first pixel with the largest difference
  std::uint32_t max_y = 0;
  std::uint64_t not_finite = 0;  ///< channel values left out
  bool identical = false;        ///< every value is equal and finite
};

/// Computes the metrics. The images MUST have the same size and not be empty.
ErrorMetrics error_metrics(const Image& image, const Image& reference);

}  // namespace bandsaw
