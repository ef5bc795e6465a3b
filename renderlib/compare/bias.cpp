// Collects the differences between image and reference for each block (a tile of 16 x 16 pixels),
// computes Student's t of their mean, and counts the blocks whose t is too large to be noise. The
// pixels of a block are divided into groups (render/pixel_groups.h). Pixels of one group may share
// paths, so their noise is not independent. Student's t needs independent values, so the mean
// difference of a group counts as one value.

#include "renderlib/compare/bias.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "renderlib/render/pixel_groups.h"

namespace bandsaw {
namespace {

/// Blocks with fewer than kMinValues values are left out.
constexpr std::uint64_t kMinValues = 8;

/// Running mean and variance (Welford 1962).
struct Moments {
  std::uint64_t count = 0;
  double mean = 0;
  double squares = 0;  // sum of squared deviations from the mean

  void add(double value) {
    ++count;
    const double from_old = value - mean;
    mean += from_old / static_cast<double>(count);
    squares += from_old * (value - mean);
  }

  /// Returns the mean divided by its standard error; 0 if the mean is 0 or there are fewer than two
  /// values, infinite if the error alone is 0.
  double t() const {
    const auto n = static_cast<double>(count);
    if (count < 2 || mean == 0) {
      return 0;
    }
    const double error = std::sqrt(squares / (n - 1) / n);
    return error > 0 ? mean / error : std::copysign(kInfinity, mean);
  }
};

// Returns the upper tail probability of the standard normal distribution for x > 0: Abramowitz and
// Stegun 1964, 26.2.17. The absolute error is below 1e-7, the relative error below 0.3 % for x up
// to 5.5, which is enough for a bound.
double upper_tail(double x) {
  const double k = 1 / (1 + 0.2316419 * x);
  const double polynomial =
      k *
      (0.319381530 + k * (-0.356563782 + k * (1.781477937 + k * (-1.821255978 + k * 1.330274429))));
  return exp(-0.5 * x * x) / std::sqrt(2 * kPi) * polynomial;
}

// Returns the bound b for which the largest absolute value of `tests` independent standard normal
// values exceeds b with probability 1 %.
double bound_of(std::uint32_t tests) {
  // `one` is the probability that a single value exceeds the bound. Bisection finds the bound.
  const double one = -expm1(log1p(-0.01) / tests);
  double low = 0;
  double high = 12;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (2 * upper_tail(middle) > one ? low : high) = middle;
  }
  return high;
}

// Converts Student's t of a sample of `values` numbers to the standard normal value >= 0 that has
// the same two-sided probability (Wallace 1959, "Bounds on Normal Approximations to Student's and
// the Chi-Square Distributions").
double as_normal(double t, std::uint64_t values) {
  const auto freedom = static_cast<double>(values - 1);
  return std::sqrt(freedom * log1p(t * t / freedom)) * (8 * freedom + 1) / (8 * freedom + 3);
}

// Sums over the whole image.
struct Totals {
  Moments groups;         // of the mean differences of groups
  double difference = 0;  // of all pixels
  double light = 0;       // of all pixels of the reference
};

// Adds the mean difference of the finite pixels of a group to `block` and to `totals`.
void add_group(const Image& image, const Image& reference, absl::Span<const PixelPlace> group,
               Moments& block, Totals& totals) {
  Moments difference;
  for (const auto& [x, y] : group) {
    if (is_finite(image.at(x, y)) && is_finite(reference.at(x, y))) {
      const double reference_light = luminance(reference.at(x, y));
      const double error = double{luminance(image.at(x, y))} - reference_light;
      difference.add(error);
      totals.difference += error;
      totals.light += reference_light;
    }
  }
  if (difference.count > 0) {
    block.add(difference.mean);
    totals.groups.add(difference.mean);
  }
}

// Returns the moments of the mean differences of all groups in a tile. Adds the groups to `totals`.
// Each half of the tile's pixels (a half tile) has its own groups.
Moments block_of(const Image& image, const Image& reference, const TileGrid& grid, std::size_t tile,
                 Totals& totals) {
  Moments block;
  for (const std::size_t half : {0, 1}) {
    const PixelGroups groups(grid, 2 * tile + half);
    for (std::uint32_t i = 0; i < groups.count(); ++i) {
      add_group(image, reference, groups.group(i), block, totals);
    }
  }
  return block;
}

}  // namespace

BiasTest test_bias(const Image& image, const Image& reference) {
  BiasTest test;
  const TileGrid grid{image.width, image.height};
  const double bound = bound_of(grid.columns() * grid.rows());
  Totals totals;
  for (std::size_t tile = 0; tile < grid.half_tiles() / 2; ++tile) {
    const Moments block = block_of(image, reference, grid, tile, totals);
    if (block.count < kMinValues) {
      continue;
    }
    ++test.blocks;
    const double t = block.t();
    test.suspicious_blocks += as_normal(t, block.count) > bound ? 1 : 0;
    if (std::abs(t) > std::abs(test.worst_t)) {
      test.worst_t = t;
      test.worst_x = static_cast<std::uint32_t>(tile % grid.columns()) * kTileSide;
      test.worst_y = static_cast<std::uint32_t>(tile / grid.columns()) * kTileSide;
    }
  }
  test.t = totals.groups.t();
  test.relative_bias = totals.light != 0 ? totals.difference / totals.light : 0;
  return test;
}

}  // namespace bandsaw
