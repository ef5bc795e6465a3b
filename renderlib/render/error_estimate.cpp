// ErrorSums adds up the variances of pixels. estimate() divides the sum by the number of pixels and
// finds quantiles. The upper bound of the error is the estimate plus a margin. For the margin,
// ErrorSums also adds up the squares of the variances of groups of pixels.

#include "renderlib/render/error_estimate.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>

#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// Added to divisors, so that relative errors of dark pixels do not dominate.
constexpr double kDivisorOffset = 0.01;

// Ratio of the variance of T - V to the sum of the squared contributions of the groups to V. T is
// the squared error of one image. V is the estimate of T from nodes, which are sums over ranges of
// samples (NodeSums). T and V are sums over groups of pixels, and the groups are independent
// (sampling/sampler.h, render/pixel_groups.h). Assume that the errors within a group are normal
// and, in the worst case, the same for all its pixels, with variance s. Then the group's
// contributions to T and V are independent, with variances 2 s^2 and r s^2, where r = 2 for two
// halves and about 1 with further nodes. So the group adds (2 + r) s^2 to the variance of T - V,
// and on average (1 + r) s^2 to the sum of squares: the ratio is between 4/3 and 3/2. If the pixels
// of a group are independent, the margin is too wide, by a factor of at most sqrt(10 / 3). That
// matters little in an image of many pixels. It does not matter either if one pixel of a group is
// bright, because then this pixel dominates the square of the group. Rare bright samples occur in
// both T and V, which makes the difference smaller.
constexpr double kVarianceOverSquares = 1.5;
// Width of the margin in standard deviations of T - V. If T - V were normal, 1.64 would suffice in
// 19 of 20 cases. The larger value covers repeated stopping decisions. It also covers images of few
// pixels: their sums are skewed, and when V happens to be too small, so is the sum of squares from
// which the margin is computed (tests/unit/cli/stop_at_error_test.cpp; NOTES.md lists the
// alternatives that were tried).
constexpr double kDeviations = 3;

/// Mean of a channel of a pixel, and the variance of that mean.
struct Estimated {
  double mean = 0;
  double variance = 0;
};

/// Returns the estimate for channel k, by the formulas of ErrorSums::add(). `first` is the mean of
/// the first two nodes, and `of_first` is the variance of this mean. The variances of the nodes are
/// weighed by the squares of their numbers of samples.
Estimated of_channel(absl::Span<const NodeSums> nodes, std::size_t k) {
  const auto half = static_cast<double>(nodes[0].samples);
  const double a = nodes[0].sums[k];
  const double b = nodes[1].sums[k];
  const double first = (a + b) / (2 * half);
  const double of_first = (a - b) * (a - b) / (4 * half * half);
  double samples = 2 * half;
  double sum = a + b;
  double weighed = samples * samples * of_first;
  for (const NodeSums& node : nodes.subspan(2)) {
    const auto n = static_cast<double>(node.samples);
    const double off = node.sums[k] / n - first;
    weighed += n * n * (off * off - of_first);
    sum += node.sums[k];
    samples += n;
  }
  return {sum / samples, weighed / (samples * samples)};
}

// Returns the value below which the share `share` (0 to 1) of all values lies. Reorders `values`.
double quantile(std::vector<float>& values, double share) {
  const auto at = static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Returns ErrorEstimate::worst_share.
double share_of_worst(std::vector<float> variances) {
  // In smaller images one pixel is a large part of the image.
  constexpr std::size_t kMinPixels = 64;
  if (variances.size() < kMinPixels) {
    return 0;
  }
  const double all = std::accumulate(variances.begin(), variances.end(), 0.0);
  const auto worst = static_cast<std::ptrdiff_t>((variances.size() + 999) / 1000);
  std::nth_element(variances.begin(), variances.begin() + worst - 1, variances.end(),
                   std::greater<>());
  return all > 0 ? std::accumulate(variances.begin(), variances.begin() + worst, 0.0) / all : 0;
}

}  // namespace

double known_error(const std::optional<ErrorEstimate>& estimate, std::uint64_t samples) {
  const bool known = estimate && std::isfinite(estimate->at_most()) &&
                     (estimate->mean > 0 || estimate->at_most() > 0 || samples >= kBlackSamples);
  return known ? estimate->at_most() : -1;
}

void ErrorSums::add(absl::Span<const NodeSums> nodes) {
  BANDSAW_CHECK(nodes.size() >= 2 && nodes[0].samples == nodes[1].samples,
                "the error is computed from halves");
  double of_pixel = 0;
  double value = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    const Estimated channel = of_channel(nodes, c);
    relative_squares_ += channel.variance / (channel.mean * channel.mean + kDivisorOffset);
    of_pixel += channel.variance;
    value += channel.mean;
  }
  sum_ += value;
  of_group_ += of_pixel;
  // A sample of 1e30 makes the variance exceed the range of float, and infinity would make the
  // shares NaN.
  constexpr double kMax = std::numeric_limits<float>::max();
  variances_.push_back(static_cast<float>(std::clamp(of_pixel / 3, 0.0, kMax)));
  means_.push_back(static_cast<float>(value / 3));
}

void ErrorSums::end_group() {
  squares_ += of_group_;
  squared_variances_ += of_group_ * of_group_;
  of_group_ = 0;
}

ErrorEstimate ErrorSums::estimate() const {
  const double count = 3 * static_cast<double>(variances_.size());
  ErrorEstimate out;
  out.mean = sum_ / count;
  out.rmse = std::sqrt(std::max(0.0, squares_ / count));
  out.relative_mse = std::max(0.0, relative_squares_ / count);
  if (out.mean > 0) {
    const double beyond = kDeviations * std::sqrt(kVarianceOverSquares * squared_variances_);
    out.relative_rmse = out.rmse / out.mean;
    out.margin =
        std::sqrt((std::max(0.0, squares_) + beyond) / count) / out.mean - out.relative_rmse;
    std::vector<float> relative(variances_.size());
    for (std::size_t i = 0; i < relative.size(); ++i) {
      relative[i] = static_cast<float>(std::sqrt(double{variances_[i]}) /
                                       (means_[i] + kDivisorOffset * out.mean));
    }
    out.median = quantile(relative, 0.5);
    out.percentile_95 = quantile(relative, 0.95);
    out.percentile_99 = quantile(relative, 0.99);
  }
  out.worst_share = share_of_worst(variances_);
  return out;
}

}  // namespace bandsaw
