#include "coordinator/cli/image_metrics.h"

#include <cmath>
#include <limits>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"

namespace bandsaw::coordinator {
namespace {

struct Sums {
  double squares = 0;
  double relative_squares = 0;
  double reference = 0;
  std::uint64_t count = 0;
};

void add_channel(double a, double b, std::size_t pixel, std::uint32_t width, Sums& sums,
                 ImageMetrics& metrics) {
  if (!std::isfinite(a) || !std::isfinite(b)) {
    ++metrics.not_finite;
    return;
  }
  const double difference = a - b;
  sums.squares += difference * difference;
  sums.relative_squares += difference * difference / (b * b + 0.01);
  sums.reference += b;
  ++sums.count;
  if (std::abs(difference) > metrics.max_difference) {
    metrics.max_difference = std::abs(difference);
    metrics.max_x = static_cast<std::uint32_t>(pixel % width);
    metrics.max_y = static_cast<std::uint32_t>(pixel / width);
  }
}

}  // namespace

absl::StatusOr<ImageMetrics> compare_images(const Image& image, const Image& reference) {
  if (image.width != reference.width || image.height != reference.height) {
    return absl::InvalidArgumentError(absl::StrCat("the images differ in size: ", image.width, "×",
                                                   image.height, " and ", reference.width, "×",
                                                   reference.height));
  }
  ImageMetrics metrics;
  Sums sums;
  for (std::size_t i = 0; i < image.pixels.size(); ++i) {
    const Rgb& a = image.pixels[i];
    const Rgb& b = reference.pixels[i];
    add_channel(a.r, b.r, i, image.width, sums, metrics);
    add_channel(a.g, b.g, i, image.width, sums, metrics);
    add_channel(a.b, b.b, i, image.width, sums, metrics);
  }
  metrics.identical = metrics.max_difference == 0 && metrics.not_finite == 0;
  if (sums.count > 0) {
    const auto count = static_cast<double>(sums.count);
    const double mean = sums.reference / count;
    metrics.rmse = std::sqrt(sums.squares / count);
    metrics.relative_mse = sums.relative_squares / count;
    metrics.relative_rmse = metrics.rmse == 0 ? 0
                            : mean != 0       ? metrics.rmse / std::abs(mean)
                                              : std::numeric_limits<double>::infinity();
  }
  return metrics;
}

std::string metrics_text(const ImageMetrics& metrics) {
  if (metrics.identical) {
    return "identical";
  }
  std::string text = absl::StrFormat(
      "RMSE %.4g · relRMSE %.4g %% · relMSE %.4g · max difference %.4g at pixel (%d, %d)",
      metrics.rmse, metrics.relative_rmse * 100, metrics.relative_mse, metrics.max_difference,
      metrics.max_x, metrics.max_y);
  if (metrics.not_finite > 0) {
    absl::StrAppend(&text, " · ", metrics.not_finite, " values are not finite and were left out");
  }
  return text;
}

}  // namespace bandsaw::coordinator
