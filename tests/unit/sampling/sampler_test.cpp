// Stratification, independence and recorded bits of the sampler. The sampler returns scrambled
// Sobol' points, which are a pure function of seed, pixel, sample and dimension. A group is four
// dimensions, whose numbers are returned by one call. An id such as R1 in a test's name is that of
// a case in tests/hard_cases/cases.txt.

#include "renderlib/sampling/sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

TEST(Sampler, DependsOnItsArgumentsAlone) {
  const std::uint32_t order[] = {3, 0, 7, 1, 6, 2, 5, 4};
  const PixelSampler sampler(9, 4, 5);
  std::vector<Sample4> shuffled(8);
  for (const std::uint32_t i : order) {
    shuffled[i] = sampler.group(i, 2);
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(shuffled[i], sample4({9, 4, 5, i}, 2));
  }
}

TEST(Sampler, ChangesWithEveryArgument) {
  const SampleKey key = {1, 2, 3, 4};
  const Sample4 base = sample4(key, 5);
  EXPECT_NE(base, sample4({2, 2, 3, 4}, 5));
  EXPECT_NE(base, sample4({1, 3, 3, 4}, 5));
  EXPECT_NE(base, sample4({1, 2, 4, 4}, 5));
  EXPECT_NE(base, sample4({1, 2, 3, 5}, 5));
  EXPECT_NE(base, sample4(key, 6));
  EXPECT_NE(sample4({1, 2, 3, 4}, 5), sample4({1, 3, 2, 4}, 5));
}

/// If these numbers change, every image changes. The pixel version, which a worker and its
/// coordinator must have in common, MUST then be raised.
TEST(Sampler, GivesTheRecordedNumbers) {
  const auto in_units = [](const Sample4& s) {
    std::array<std::uint32_t, 4> units{};
    for (std::size_t k = 0; k < 4; ++k) {
      units[k] = static_cast<std::uint32_t>(s[k] * 0x1p32);
    }
    return units;
  };
  using Units = std::array<std::uint32_t, 4>;
  EXPECT_EQ(in_units(sample4({1, 2, 3, 0}, 0)),
            (Units{1068403330, 863452365, 1404421171, 1234037980}));
  EXPECT_EQ(in_units(sample4({~0ull, ~0u, ~0u, ~0ull}, ~0u)),
            (Units{769691669, 3425894519, 956766642, 438656989}));
}

/// Counts how many of `samples` fall in each cell of a grid of 2^bits[k] cells along dimension k.
std::vector<int> cells(const std::vector<Sample4>& samples, const std::array<int, 4>& bits) {
  std::vector<int> counts(std::size_t{1} << (bits[0] + bits[1] + bits[2] + bits[3]));
  for (const Sample4& s : samples) {
    std::size_t cell = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      cell = (cell << bits[k]) | static_cast<std::size_t>(std::ldexp(s[k], bits[k]));
    }
    ++counts[cell];
  }
  return counts;
}

/// Returns the samples [block * 2^m, (block + 1) * 2^m) of a pixel for this group of dimensions.
std::vector<Sample4> aligned_range(std::uint64_t seed, std::uint32_t group, int m,
                                   std::uint64_t block) {
  const PixelSampler sampler(seed, 11, 12);
  std::vector<Sample4> samples;
  const std::uint64_t count = std::uint64_t{1} << m;
  for (std::uint64_t i = block * count; i < (block + 1) * count; ++i) {
    samples.push_back(sampler.group(i, group));
  }
  return samples;
}

/// Expects that the 2^m samples are a (t, m, s)-net in base 2 in these s dimensions. That means
/// that each elementary interval of volume 2^(t-m) has 2^t of the points.
void expect_net(const std::vector<Sample4>& samples, int m,
                const std::vector<std::size_t>& dimensions, int t) {
  const int bits = m - t;
  const auto full = [&](const std::array<int, 4>& shape) {
    for (const int count : cells(samples, shape)) {
      ASSERT_EQ(count, 1 << t) << "shape " << shape[0] << shape[1] << shape[2] << shape[3];
    }
  };
  std::array<int, 4> shape{};
  // Tries all shapes that divide the cube into 2^bits cells along these dimensions.
  const auto place = [&](auto&& self, std::size_t index, int left) -> void {
    if (index + 1 == dimensions.size()) {
      shape[dimensions[index]] = left;
      full(shape);
      return;
    }
    for (int b = 0; b <= left; ++b) {
      shape[dimensions[index]] = b;
      self(self, index + 1, left - b);
    }
  };
  place(place, 0, bits);
}

TEST(Sampler, FillsElementaryIntervalsInEveryAlignedRange) {
  for (const int m : {1, 2, 4, 7, 10}) {
    for (const std::uint64_t block : {0ull, 1ull, 5ull, 1000ull, (1ull << 32 >> m) + 3}) {
      const std::vector<Sample4> samples = aligned_range(block + 100, 3, m, block);
      for (std::size_t k = 0; k < 4; ++k) {
        expect_net(samples, m, {k}, 0);
      }
      expect_net(samples, m, {0, 1}, 0);
      if (m >= 3) {
        expect_net(samples, m, {0, 1, 2, 3}, 3);
      }
    }
  }
}

TEST(Sampler, R1_StaysBelowOne) {
  double largest = 0;
  for (std::uint64_t i = 0; i < 200000; ++i) {
    for (const double v :
         sample4({3, 1, 1, i * 0x9e3779b97f4a7c15u}, static_cast<std::uint32_t>(i))) {
      ASSERT_GE(v, 0);
      largest = std::max(largest, v);
    }
  }
  EXPECT_LT(largest, 1);
  EXPECT_GT(largest, 1 - 1e-5);
  test::report_hard_case("R1", "800,000 numbers below 1");
}

TEST(Sampler, R4_IsUniformOverPairsOfDimensionsOfAnyGroups) {
  constexpr int kPairs = 200;
  constexpr std::size_t kSide = 32;
  constexpr std::size_t kSamples = 16'384;
  const double level = test::sidak(0.01, kPairs);
  test::Random random(5);
  for (int pair = 0; pair < kPairs; ++pair) {
    const std::uint32_t group_a = random.below(64);
    const std::uint32_t group_b = random.below(64);
    const std::size_t a = random.below(4);
    const std::size_t b = group_a == group_b ? (a + 1 + random.below(3)) % 4 : random.below(4);
    const std::uint64_t seed = random.bits();
    std::vector<std::uint64_t> counts(kSide * kSide);
    // Each pixel gives one sample, so that the numbers are independent, as the test assumes.
    // Samples of one pixel are better distributed.
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      const PixelSampler sampler(seed, i % 64, i / 64);
      const double x = sampler.group(i, group_a)[a];
      const double y = sampler.group(i, group_b)[b];
      ++counts[static_cast<std::size_t>(x * kSide) * kSide + static_cast<std::size_t>(y * kSide)];
    }
    const std::vector<double> expected(counts.size(),
                                       static_cast<double>(kSamples) / counts.size());
    EXPECT_GT(test::chi_squared(counts, expected).p_value, level)
        << group_a << "." << a << " with " << group_b << "." << b;
  }
  test::report_hard_case("R4",
                         "chi-squared test passes for 200 pairs of dimensions, with 32 x 32 cells");
}

/// Samples of one pixel fill pairs of dimensions of different groups no worse than independent
/// numbers do. The statistic does not follow the chi-squared distribution here, because the samples
/// are not independent. They are stratified along each of the two dimensions.
TEST(Sampler, FillsPairsOfDimensionsOfDifferentGroupsAsWellAsIndependentNumbers) {
  constexpr std::size_t kSide = 16;
  constexpr std::uint64_t kSamples = 4096;
  test::Random random(6);
  test::Moments statistic;
  for (int pair = 0; pair < 300; ++pair) {
    const PixelSampler sampler(random.bits(), 1, 2);
    const std::uint32_t group = random.below(64);
    const std::size_t a = random.below(4);
    const std::size_t b = random.below(4);
    const std::uint32_t other = group + 1 + random.below(9);
    std::vector<std::uint64_t> counts(kSide * kSide);
    for (std::uint64_t i = 0; i < kSamples; ++i) {
      const double x = sampler.group(i, group)[a];
      const double y = sampler.group(i, other)[b];
      ++counts[static_cast<std::size_t>(x * kSide) * kSide + static_cast<std::size_t>(y * kSide)];
    }
    const std::vector<double> expected(counts.size(),
                                       static_cast<double>(kSamples) / counts.size());
    statistic.add(test::chi_squared(counts, expected).statistic);
  }
  EXPECT_LT(statistic.mean(), kSide * kSide);
  EXPECT_GT(statistic.mean(), kSide * kSide / 2.0);
}

/// Returns the correlation of the values, which are uniform in [0, 1), with the values at an offset
/// of (dx, dy) pixels. The factor 12 divides by the variance, 1/12.
double correlation(const std::vector<double>& values, std::uint32_t side, std::uint32_t dx,
                   std::uint32_t dy) {
  double sum = 0;
  std::size_t count = 0;
  for (std::uint32_t y = 0; y + dy < side; ++y) {
    for (std::uint32_t x = 0; x + dx < side; ++x) {
      sum += (values[y * side + x] - 0.5) * (values[(y + dy) * side + x + dx] - 0.5);
      ++count;
    }
  }
  return sum / static_cast<double>(count) * 12;
}

TEST(Sampler, R2_DoesNotCorrelateNeighbouringPixels) {
  constexpr std::uint32_t kSide = 256;
  for (std::uint32_t group = 0; group < 2; ++group) {
    std::array<std::vector<double>, 4> values;
    for (std::uint32_t y = 0; y < kSide; ++y) {
      for (std::uint32_t x = 0; x < kSide; ++x) {
        const Sample4 s = sample4({0, x, y, 0}, group);
        for (std::size_t k = 0; k < 4; ++k) {
          values[k].push_back(s[k]);
        }
      }
    }
    for (const std::vector<double>& dimension : values) {
      EXPECT_LT(std::abs(correlation(dimension, kSide, 1, 0)), 4.0 / kSide);
      EXPECT_LT(std::abs(correlation(dimension, kSide, 0, 1)), 4.0 / kSide);
      EXPECT_LT(std::abs(correlation(dimension, kSide, 1, 1)), 4.0 / kSide);
    }
  }
  test::report_hard_case("R2", "24 correlations of neighbouring pixels below 4 / 256");
}

TEST(Sampler, R5_SupportsMoreThanTwoToThe32Samples) {
  const PixelSampler sampler(1, 2, 3);
  std::set<Sample4> seen;
  for (std::uint64_t high = 0; high < 4; ++high) {
    for (std::uint64_t low = 0; low < 64; ++low) {
      seen.insert(sampler.group((high << 32) + low, 0));
    }
  }
  EXPECT_EQ(seen.size(), 4u * 64);
  test::report_hard_case("R5", "no sample is repeated up to index 4 x 2^32");
}

/// For a smooth integrand, the error of scrambled nets is far below the error of independent
/// samples. With 256 independent samples, the error would be 0.31 / 16. The bound is less than a
/// tenth of this number.
TEST(Sampler, IntegratesSmoothFunctionsWell) {
  test::Moments error;
  for (std::uint32_t pixel = 0; pixel < 200; ++pixel) {
    double sum = 0;
    const PixelSampler sampler(3, pixel, 0);
    for (std::uint64_t i = 0; i < 256; ++i) {
      const Sample4 s = sampler.group(i, 1);
      sum += s[0] * s[1] + s[2] * s[3];
    }
    const double difference = sum / 256 - 0.5;
    error.add(difference * difference);
  }
  EXPECT_LT(std::sqrt(error.mean()), 0.1 * 0.29 / 16);
}

}  // namespace
}  // namespace bandsaw
