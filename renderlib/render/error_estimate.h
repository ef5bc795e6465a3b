#pragma once

// How wrong an image is, told without a reference: from sums of samples that are independent of
// each other, or better than that.
//
// With Owen-scrambled points the spread of single samples says little (it is 3 to 54 times too
// large); two halves of a power-of-two number of samples differ by as much as random halves of that
// error would, or more. So the estimate is right for noise and too large, up to about 2.5 times,
// where sampling is stratified well.
//
// An estimate scatters, and so does the error of one image about that of all seeds. Who goes on
// until an estimate is small enough stops where it happens to be too small: an image whose noise is
// in 70 of its pixels and that stops so is above its target three times in ten. What can be asked
// for is therefore a bound: the estimate and a margin.

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/types/span.h"

namespace bandsaw {

/// Errors are standard deviations of the image from the mean that more samples would give, over all
/// channels of all pixels.
struct ErrorEstimate {
  double mean = 0;           ///< of the image
  double rmse = 0;           ///< sqrt(mean variance)
  double relative_rmse = 0;  ///< rmse / mean; 0 where the image is black
  double margin = 0;         ///< what at_most() adds to relative_rmse, >= 0
  double relative_mse = 0;   ///< mean(variance / (value^2 + 0.01))
  /// Of the pixels' errors, each over its value plus a hundredth of the mean: what half, 95 and 99
  /// of a hundred pixels stay below.
  double median = 0;
  double percentile_95 = 0;
  double percentile_99 = 0;
  /// The share of the variance that the worst thousandth of the pixels (at least one) has; 0 of
  /// images of fewer than 64.
  double worst_share = 0;

  /// What the relative RMSE of this very image is below, 19 times of 20 or more, also where samples
  /// are added until this reaches a target. Not where doubtful().
  double at_most() const { return relative_rmse + margin; }

  /// Rare bright paths decide the error: pixels that none has met yet show nothing of theirs, and
  /// the estimate is likely too low.
  bool doubtful() const { return worst_share > 0.3; }

  friend bool operator==(const ErrorEstimate&, const ErrorEstimate&) = default;
};

/// A black image of fewer samples says nothing: none may have met its light yet.
inline constexpr std::uint64_t kBlackSamples = 1024;

/// What the error of an image of so many samples a pixel is below (ErrorEstimate::at_most); below
/// 0: not known.
double known_error(const std::optional<ErrorEstimate>& estimate, std::uint64_t samples);

/// One pixel row's sums, of one node of its samples.
struct NodeSums {
  std::uint64_t samples = 0;
  absl::Span<const double> sums;  ///< width x 3
};

class ErrorSums {
 public:
  /// A row whose first two nodes have equally many samples; all rows have equally many pixels. With
  /// a and b their means and v = (a - b)^2 / 4 the variance of both together, the variance of a
  /// further node of mean e is taken as (e - (a + b) / 2)^2 - v, which is right on average.
  /// Pixels of one half row of a tile (render/tile_samples.h) may have found their light together,
  /// as no others may; the margin allows for it. `step`: 2 for rows of an image, where the pixels
  /// of two half rows take turns, 1 for a half row.
  void add_row(absl::Span<const NodeSums> nodes, std::size_t step);

  /// At least one row MUST have been added.
  ErrorEstimate estimate() const;

 private:
  /// Returns the pixel's variance, summed over its channels.
  double add_pixel(const double (&variances)[3], const double (&means)[3]);

  double squares_ = 0;            ///< the variances of all pixels
  double squared_variances_ = 0;  ///< the square of that of each half row
  double relative_squares_ = 0;
  double sum_ = 0;
  std::vector<float> variances_;  ///< mean over the channels, >= 0
  std::vector<float> means_;
};

}  // namespace bandsaw
