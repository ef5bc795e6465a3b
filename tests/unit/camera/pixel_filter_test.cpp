// Pixel filters: the position of a sample within or around its pixel. An id such as C6 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/camera/pixel_filter.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "renderlib/sampling/sampler.h"
#include "tests/support/hard_case.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using Kind = PixelFilter::Kind;

// The default filter is a box of one pixel. The position of a sample is the corner of the pixel
// plus the random numbers, to the bit.
TEST(PixelFilter, TheDefaultAddsTheRandomNumberToThePixelExactly) {
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Sample4 at = sample4({.seed = 1, .x = 3, .y = 4, .sample = i}, kGroupCamera);
    for (const std::uint32_t x : {0u, 1u, 1000u, 65535u}) {
      EXPECT_EQ(x + 0.5 + sample(PixelFilter{}, at[0], at[1]).x, x + at[0]);
    }
  }
}

TEST(PixelFilter, C6_TheLastRandomNumberBelowOneStaysInThePixel) {
  const double last = 1 - 0x1p-32;
  for (const double x : {0.0, 65535.0, 1048575.0}) {
    EXPECT_EQ(std::floor(x + 0.5 + sample(PixelFilter{}, last, 0).x), x);
  }
  test::report_hard_case("C6", "the sample stays in its pixel for x = 0, 65535 and 2^20 - 1");
}

/// Returns the density of a filter of radius 1 at (x, y), not normalised. The standard deviation of
/// the Gaussian is a third of the radius.
double density(Kind kind, double x, double y) {
  switch (kind) {
    case Kind::kBox:
      return 1;
    case Kind::kTent:
      return (1 - std::abs(x)) * (1 - std::abs(y));
    case Kind::kGaussian:
      return x * x + y * y < 1 ? std::exp(-(x * x + y * y) * 4.5) : 0;
  }
  return 0;
}

/// The probability of a false alarm is 1 % for the three filters together.
TEST(PixelFilter, SamplesFollowTheDensity) {
  constexpr int kCells = 16;
  constexpr int kFine = 32;  // the density is summed at 32 x 32 points of each cell
  constexpr std::uint64_t kSamples = 200'000;
  for (const Kind kind : {Kind::kBox, Kind::kTent, Kind::kGaussian}) {
    std::vector<double> expected(kCells * kCells);
    double sum = 0;
    for (int i = 0; i < kCells * kFine; ++i) {
      for (int j = 0; j < kCells * kFine; ++j) {
        const double x = (i + 0.5) / (kCells * kFine) * 2 - 1;
        const double y = (j + 0.5) / (kCells * kFine) * 2 - 1;
        const double value = density(kind, x, y);
        expected[static_cast<std::size_t>(i / kFine * kCells + j / kFine)] += value;
        sum += value;
      }
    }
    for (double& cell : expected) {
      cell *= kSamples / sum;
    }
    std::vector<std::uint64_t> counts(kCells * kCells);
    const PixelFilter filter{kind, 2.5};
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      // Takes one sample of each pixel, because the samples of one pixel are stratified and so are
      // not independent.
      const Sample4 at = sample4({.seed = 9, .x = static_cast<std::uint32_t>(i), .y = 7}, 0);
      const Vec2 offset = sample(filter, at[0], at[1]) * (1 / filter.radius);
      ASSERT_LE(std::max(std::abs(offset.x), std::abs(offset.y)), 1);
      const int cell_x = std::min(kCells - 1, static_cast<int>((offset.x + 1) / 2 * kCells));
      const int cell_y = std::min(kCells - 1, static_cast<int>((offset.y + 1) / 2 * kCells));
      ++counts[static_cast<std::size_t>(cell_x * kCells + cell_y)];
    }
    EXPECT_GT(test::chi_squared(counts, expected).p_value, test::sidak(0.01, 3))
        << static_cast<int>(kind);
  }
}

TEST(PixelFilter, ARadiusOfZeroGivesTheCentre) {
  for (const Kind kind : {Kind::kBox, Kind::kTent, Kind::kGaussian}) {
    EXPECT_EQ(sample({kind, 0}, 0.3, 0.8), (Vec2{0, 0}));
  }
}

TEST(PixelFilter, RadiiOutOfRangeAreRefused) {
  EXPECT_TRUE(validate(PixelFilter{Kind::kTent, 16}).ok());
  for (const double radius : {-0.1, 16.1, std::nan("")}) {
    EXPECT_FALSE(validate(PixelFilter{Kind::kTent, radius}).ok());
  }
}

}  // namespace
}  // namespace bandsaw
