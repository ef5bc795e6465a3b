#include "renderlib/compare/bias.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

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

  /// Returns the mean divided by its standard error; 0 if the mean is 0.
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
// Stegun 1964, 26.2.17, with a relative error below 1e-7 in the range used here.
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
  const double one = -expm1(log1p(-0.01) / tests);
  double low = 0;
  double high = 12;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (2 * upper_tail(middle) > one ? low : high) = middle;
  }
  return high;
}

// Converts Student's t to the standard normal value of the same probability (Wallace 1959, "Bounds
// on Normal Approximations to Student's and the Chi-Square Distributions").
double as_normal(double t, std::uint64_t values) {
  const auto freedom = static_cast<double>(values - 1);
  return std::sqrt(freedom * log1p(t * t / freedom)) * (8 * freedom + 1) / (8 * freedom + 3);
}

// Sums over all pixels.
struct Totals {
  Moments half_rows;
  double difference = 0;
  double light = 0;
};

// Adds the finite pixels x, x + 2, … below x1 of a row.
void add_half_row(const Image& image, const Image& reference, std::uint32_t x, std::uint32_t x1,
                  std::uint32_t y, Moments& block, Totals& totals) {
  Moments difference;
  for (; x < x1; x += 2) {
    if (is_finite(image.at(x, y)) && is_finite(reference.at(x, y))) {
      const double there = luminance(reference.at(x, y));
      const double off = double{luminance(image.at(x, y))} - there;
      difference.add(off);
      totals.difference += off;
      totals.light += there;
    }
  }
  if (difference.count > 0) {
    block.add(difference.mean);
    totals.half_rows.add(difference.mean);
  }
}

Moments block_of(const Image& image, const Image& reference, std::uint32_t x0, std::uint32_t y0,
                 Totals& totals) {
  Moments block;
  const std::uint32_t x1 = std::min(x0 + kBiasBlock, image.width);
  for (std::uint32_t y = y0; y < std::min(y0 + kBiasBlock, image.height); ++y) {
    for (const std::uint32_t first : {x0, x0 + 1}) {
      add_half_row(image, reference, first, x1, y, block, totals);
    }
  }
  return block;
}

}  // namespace

BiasTest test_bias(const Image& image, const Image& reference) {
  BiasTest test;
  const auto along = [](std::uint32_t size) { return (size + kBiasBlock - 1) / kBiasBlock; };
  const double bound = bound_of(along(image.width) * along(image.height));
  Totals totals;
  for (std::uint32_t y = 0; y < image.height; y += kBiasBlock) {
    for (std::uint32_t x = 0; x < image.width; x += kBiasBlock) {
      const Moments block = block_of(image, reference, x, y, totals);
      if (block.count < kMinValues) {
        continue;
      }
      ++test.blocks;
      const double t = block.t();
      test.suspicious_blocks += as_normal(t, block.count) > bound ? 1 : 0;
      if (std::abs(t) > std::abs(test.worst_t)) {
        test.worst_t = t;
        test.worst_x = x;
        test.worst_y = y;
      }
    }
  }
  test.t = totals.half_rows.t();
  test.relative_bias = totals.light != 0 ? totals.difference / totals.light : 0;
  return test;
}

}  // namespace bandsaw
