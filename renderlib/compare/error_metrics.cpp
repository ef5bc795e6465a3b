// Adds up the errors of all channels in one pass over the pixels.

#include "renderlib/compare/error_metrics.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <vector>

#include "renderlib/compare/perceived.h"
#include "renderlib/image/srgb.h"
#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Is added to the divisors of relative errors, so that dark pixels do not dominate.
constexpr double kDivisorOffset = 0.01;

/// Sums over all finite channel values.
struct Sums {
  double squares = 0;
  double relative = 0;
  double coded_squares = 0;  ///< of sRGB-coded values
  double reference = 0;
  std::uint64_t count = 0;
};

/// Returns the sRGB-coded value in [0, 1].
double shown(float linear) { return srgb_curve(clamped(gray(linear)).r); }

/// Adds a channel of a pixel to the sums. Returns its relative squared error, (image - reference)^2
/// / (reference^2 + kDivisorOffset).
double add_channel(float image, float reference, Sums& sums) {
  const double a = image;
  const double b = reference;
  const double difference = a - b;
  const double on_screen = shown(image) - shown(reference);
  sums.squares += difference * difference;
  sums.relative += std::abs(difference) / (std::abs(b) + kDivisorOffset);
  sums.coded_squares += on_screen * on_screen;
  sums.reference += b;
  ++sums.count;
  return difference * difference / (b * b + kDivisorOffset);
}

struct PixelError {
  double relative_squares = 0;  ///< sum over the channels
  double largest = 0;           ///< largest absolute difference
};

/// Adds each channel that is finite in both images to `sums`, and counts the other channels in
/// `not_finite`. Returns the errors of the pixel.
PixelError add_pixel(const Rgb& image, const Rgb& reference, Sums& sums,
                     std::uint64_t& not_finite) {
  const float a[3] = {image.r, image.g, image.b};
  const float b[3] = {reference.r, reference.g, reference.b};
  PixelError error;
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(a[c]) || !std::isfinite(b[c])) {
      ++not_finite;
      continue;
    }
    error.relative_squares += add_channel(a[c], b[c], sums);
    error.largest = std::max(error.largest, std::abs(double{a[c]} - b[c]));
  }
  return error;
}

// Returns the mean of `sums` without the largest thousandth of the sums. `sums` holds one sum for
// each pixel. The number of sums left out is rounded up, but if there is only one sum, it is kept.
// Reorders `sums`.
double trimmed_mean(std::vector<double>& sums) {
  const std::size_t worst = sums.size() < 2 ? 0 : (sums.size() + 999) / 1000;
  std::nth_element(sums.begin(), sums.begin() + static_cast<std::ptrdiff_t>(worst), sums.end(),
                   std::greater<>());
  return std::accumulate(sums.begin() + static_cast<std::ptrdiff_t>(worst), sums.end(), 0.0) /
         static_cast<double>(sums.size() - worst);
}

// Sets the metrics that are means. `pixels` holds each pixel's sum of relative squared errors.
// sums.count MUST NOT be 0.
void set_means(const Sums& sums, std::vector<double>& pixels, ErrorMetrics& metrics) {
  const auto count = static_cast<double>(sums.count);
  const double mean = sums.reference / count;
  metrics.rmse = std::sqrt(sums.squares / count);
  metrics.relative_rmse = metrics.rmse == 0 ? 0
                          : mean != 0       ? metrics.rmse / std::abs(mean)
                                            : kInfinity;
  metrics.mape = sums.relative / count;
  metrics.psnr =
      sums.coded_squares == 0 ? kInfinity : -10 * log(sums.coded_squares / count) / log(10);
  metrics.relative_mse = std::accumulate(pixels.begin(), pixels.end(), 0.0) / count;
  metrics.trimmed_relative_mse = trimmed_mean(pixels) * static_cast<double>(pixels.size()) / count;
}

}  // namespace

ErrorMetrics error_metrics(const Image& image, const Image& reference) {
  ErrorMetrics metrics;
  Sums sums;
  std::vector<double> relative_squares(image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const PixelError error =
        add_pixel(image.pixels[i], reference.pixels[i], sums, metrics.not_finite);
    relative_squares[i] = error.relative_squares;
    if (error.largest > metrics.max_difference) {
      metrics.max_difference = error.largest;
      metrics.max_x = static_cast<std::uint32_t>(i % image.width);
      metrics.max_y = static_cast<std::uint32_t>(i / image.width);
    }
  }
  metrics.identical = metrics.max_difference == 0 && metrics.not_finite == 0;
  if (sums.count > 0) {
    set_means(sums, relative_squares, metrics);
  } else {
    metrics.rmse = metrics.relative_rmse = metrics.mape = metrics.psnr = metrics.relative_mse =
        metrics.trimmed_relative_mse = std::numeric_limits<double>::quiet_NaN();
  }
  return metrics;
}

}  // namespace bandsaw
