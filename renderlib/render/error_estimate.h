#pragma once

// Error estimate of an image without a reference, from sums of samples that are independent or
// stratified. Film::error() makes the estimate. Jobs with an error target use it to decide when to
// stop.
//
// With Owen-scrambled points, an estimate from the variance of single samples would be 3 to 54
// times too large. So the estimate is made from the difference of the two halves of a power-of-two
// number of samples. If the halves were independent, the variance of this difference would be four
// times that of their mean. The halves of one sequence are not independent: where sampling is well
// stratified, their errors partly cancel in the mean. So the estimate is right for pure noise, and
// up to about 2.5 times too large where sampling is well stratified.
//
// An estimate scatters. The error of one image scatters too, around the mean over all seeds. A job
// that stops as soon as the estimate is small enough often stops when the estimate happens to be
// too small: three in ten images whose noise is in only 70 pixels would end above their target. So
// the stop rule uses an upper bound: the estimate plus a margin.

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/types/span.h"

namespace bandsaw {

/// Errors are standard deviations of the image from its expected value, over all channels of all
/// pixels.
struct ErrorEstimate {
  double mean = 0;           ///< mean value of the image
  double rmse = 0;           ///< square root of the mean variance
  double relative_rmse = 0;  ///< rmse / mean; 0 if the image is black
  double margin = 0;         ///< difference between at_most() and relative_rmse, >= 0
  double relative_mse = 0;   ///< mean(variance / (value^2 + 0.01))
  /// Quantiles (50 %, 95 %, 99 %) of the pixels' errors, each relative to the pixel's value plus a
  /// hundredth of the mean.
  double median = 0;
  double percentile_95 = 0;
  double percentile_99 = 0;
  /// Share of the total variance in the worst thousandth of the pixels (at least one); 0 for images
  /// of fewer than 64 pixels.
  double worst_share = 0;

  /// Returns an upper bound of this image's relative RMSE. The bound holds in at least 19 of 20
  /// cases, also if samples are added until the bound reaches a target. Not valid if doubtful().
  double at_most() const { return relative_rmse + margin; }

  /// Returns true if rare bright paths dominate the error. Pixels that have not sampled such a path
  /// show none of this variance, so the estimate is likely too low.
  bool doubtful() const { return worst_share > 0.3; }

  friend bool operator==(const ErrorEstimate&, const ErrorEstimate&) = default;
};

/// A black image with fewer samples than this is inconclusive: no path may have reached its lights.
inline constexpr std::uint64_t kBlackSamples = 1024;

/// Returns ErrorEstimate::at_most() of an image with `samples` samples per pixel. Returns a
/// negative number if the error is unknown. It is unknown if there is no estimate, if at_most() is
/// not finite, or if the image is black and has fewer than kBlackSamples samples per pixel.
double known_error(const std::optional<ErrorEstimate>& estimate, std::uint64_t samples);

/// Sums of a pixel over one node of its samples. A node is an aligned range of a power-of-two
/// number of blocks of 8 samples (render/band.h).
struct NodeSums {
  std::uint64_t samples = 0;
  absl::Span<const double> sums;  ///< r, g, b
};

/// Accumulates the variances of pixels.
class ErrorSums {
 public:
  /// Adds a pixel. `nodes` are its contiguous nodes from sample 0 on; the first two MUST have
  /// equally many samples. Let a and b be the means of the first two nodes. The variance of their
  /// common mean is estimated by v = (a - b)^2 / 4. The variance of a further node of mean e is
  /// estimated by (e - (a + b) / 2)^2 - v, which is unbiased.
  void add(absl::Span<const NodeSums> nodes);
  /// Ends a group, which consists of the pixels added since the last call. The errors of pixels in
  /// one group (render/pixel_groups.h) may be correlated by path reuse. The errors of pixels in
  /// different groups are not correlated. The margin accounts for the correlations within groups.
  void end_group();

  /// Returns the estimate. At least one pixel MUST have been added, and its group ended.
  ErrorEstimate estimate() const;

 private:
  double squares_ = 0;            ///< sum of the pixels' variances
  double of_group_ = 0;           ///< sum of the variances of the pixels of the present group
  double squared_variances_ = 0;  ///< sum of the squared variances of groups
  double relative_squares_ = 0;
  double sum_ = 0;
  std::vector<float> variances_;  ///< per pixel, mean over the channels, >= 0
  std::vector<float> means_;
};

}  // namespace bandsaw
