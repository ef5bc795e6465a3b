#include "renderlib/compare/bias.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Mean and spread in one pass (Welford 1962).
struct Moments {
  std::uint64_t count = 0;
  double mean = 0;
  double squares = 0;  // of the distances from the mean

  void add(double value) {
    ++count;
    const double from_old = value - mean;
    mean += from_old / static_cast<double>(count);
    squares += from_old * (value - mean);
  }

  /// The mean over its standard error; 0 where all values are 0.
  double t() const {
    const auto n = static_cast<double>(count);
    if (count < 2 || mean == 0) {
      return 0;
    }
    const double error = std::sqrt(squares / (n - 1) / n);
    return error > 0 ? mean / error : std::copysign(kInfinity, mean);
  }
};

// The probability that a normal number is above x > 0: Abramowitz and Stegun 1964, 26.2.17, off by
// less than 1e-7 of it where it matters here.
double upper_tail(double x) {
  const double k = 1 / (1 + 0.2316419 * x);
  const double polynomial =
      k *
      (0.319381530 + k * (-0.356563782 + k * (1.781477937 + k * (-1.821255978 + k * 1.330274429))));
  return exp(-0.5 * x * x) / std::sqrt(2 * kPi) * polynomial;
}

// The two-sided bound that each of `tests` passes so rarely that any does once in a hundred.
double bound_of(std::uint32_t tests) {
  const double one = -expm1(log1p(-0.01) / tests);
  double low = 0;
  double high = 12;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    (2 * upper_tail(middle) > one ? low : high) = middle;
  }
  // Student's t of few values has heavier tails than the normal law; of 256 hardly.
  return high * 1.05;
}

Moments block_of(const Image& image, const Image& reference, std::uint32_t x0, std::uint32_t y0,
                 Moments& all, Moments& light) {
  Moments block;
  for (std::uint32_t y = y0; y < std::min(y0 + kBiasBlock, image.height); ++y) {
    for (std::uint32_t x = x0; x < std::min(x0 + kBiasBlock, image.width); ++x) {
      if (!is_finite(image.at(x, y)) || !is_finite(reference.at(x, y))) {
        continue;
      }
      const double there = luminance(reference.at(x, y));
      const double difference = double{luminance(image.at(x, y))} - there;
      block.add(difference);
      all.add(difference);
      light.add(there);
    }
  }
  return block;
}

}  // namespace

BiasTest test_bias(const Image& image, const Image& reference) {
  BiasTest test;
  const auto along = [](std::uint32_t size) { return (size + kBiasBlock - 1) / kBiasBlock; };
  const double bound = bound_of(along(image.width) * along(image.height));
  Moments all;
  Moments light;
  for (std::uint32_t y = 0; y < image.height; y += kBiasBlock) {
    for (std::uint32_t x = 0; x < image.width; x += kBiasBlock) {
      const Moments block = block_of(image, reference, x, y, all, light);
      if (block.count < kBiasBlock) {
        continue;
      }
      ++test.blocks;
      const double t = block.t();
      test.suspicious_blocks += std::abs(t) > bound ? 1 : 0;
      if (std::abs(t) > std::abs(test.worst_t)) {
        test.worst_t = t;
        test.worst_x = x;
        test.worst_y = y;
      }
    }
  }
  test.t = all.t();
  test.relative_bias = light.mean != 0 ? all.mean / light.mean : 0;
  return test;
}

}  // namespace bandsaw
