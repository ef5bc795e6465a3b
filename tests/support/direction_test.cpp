// Tests samplers of directions: counts the samples in cells of equal solid angle and compares the
// counts with the integral of the pdf over each cell, by the chi-squared test.

#include "tests/support/direction_test.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <vector>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw::test {
namespace {

constexpr std::size_t kBands = 10;  // in z, of equal area
constexpr std::size_t kSectors = 20;
constexpr std::size_t kSteps = 48;  // quadrature points per cell and axis
constexpr int kSamples = 100000;

/// Returns the cell of a unit vector: bands of equal height in z, sectors of equal azimuth.
std::size_t cell_of(const Vec3& d) {
  const double turn = atan2(d.y, d.x) / (2 * kPi) + 0.5;
  const auto band = static_cast<std::size_t>((d.z + 1) * 0.5 * kBands);
  const auto sector = static_cast<std::size_t>(turn * kSectors);
  return std::min(band, kBands - 1) * kSectors + std::min(sector, kSectors - 1);
}

/// Integrates the pdf over each cell by the midpoint rule.
std::vector<double> integrate(absl::FunctionRef<double(const Vec3&)> density) {
  std::vector<double> cells(kBands * kSectors);
  const double step = 4 * kPi / static_cast<double>(cells.size() * kSteps * kSteps);
  for (std::size_t i = 0; i < kBands * kSteps; ++i) {
    const double z = (static_cast<double>(i) + 0.5) / (0.5 * kBands * kSteps) - 1;
    const double r = std::sqrt(1 - z * z);
    for (std::size_t j = 0; j < kSectors * kSteps; ++j) {
      const SinCos phi = sincos_turns((static_cast<double>(j) + 0.5) / (kSectors * kSteps) - 0.5);
      cells[i / kSteps * kSectors + j / kSteps] += step * density({r * phi.cos, r * phi.sin, z});
    }
  }
  return cells;
}

}  // namespace

void expect_samples_match_density(absl::FunctionRef<Vec3(double, double)> sample,
                                  absl::FunctionRef<double(const Vec3&)> density,
                                  std::uint64_t seed, std::size_t tests) {
  std::vector<double> expected = integrate(density);
  Random random(seed);
  std::vector<std::uint64_t> counts(expected.size());
  std::uint64_t lost = 0;
  for (int i = 0; i < kSamples; ++i) {
    const double u = random.uniform();
    const Vec3 d = sample(u, random.uniform());  // a unit vector; zero if the sample is lost
    if (d == Vec3{}) {
      ++lost;
      continue;
    }
    ASSERT_NEAR(length(d), 1, 1e-12);
    ASSERT_GT(density(d), 0);
    ++counts[cell_of(d)];
  }
  double total = 0;
  for (double& cell : expected) {
    total += cell;
    cell *= kSamples;
  }
  if (lost == 0) {
    EXPECT_NEAR(total, 1, 5e-3);  // the midpoint rule is less exact at steps of the pdf
    for (double& cell : expected) {
      cell /= total;
    }
  } else {
    counts.push_back(lost);  // one more cell: the samples that are lost
    expected.push_back(std::max(0.0, 1 - total) * kSamples);
  }
  const ChiSquared result = chi_squared(counts, expected);
  EXPECT_GT(result.p_value, sidak(0.01, tests))
      << "chi-squared " << result.statistic << ", degrees of freedom " << result.degrees;
}

}  // namespace bandsaw::test
