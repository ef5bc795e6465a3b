// Sampling of linearly interpolated rows of texels, as environment maps need it. The tent of a
// texel is its weight in linear interpolation: it is 1 at the centre of the texel and falls to 0 at
// the centres of the neighbouring texels.

#include "renderlib/sampling/tent.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/constants.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;

constexpr int kCells = 400;  ///< cells of the chi-squared test
constexpr int kSteps = 64;   ///< steps of the integral of the pdf over a cell
constexpr int kSamples = 100000;

/// Returns the weight of texel `index` at position x by the definition of linear interpolation. The
/// unit of x is a texel. `ends` says whether the row of texels is clamped at its ends or repeated.
double tent(double x, std::uint32_t index, std::uint32_t texels, Ends ends) {
  const double centre = index + 0.5;
  if (ends == Ends::kClamped) {
    const double clamped = std::min(std::max(x, 0.5), texels - 0.5);
    return std::max(0.0, 1 - std::abs(clamped - centre));
  }
  double sum = 0;
  for (const double turn : {-1.0, 0.0, 1.0}) {
    sum += std::max(0.0, 1 - std::abs(x + turn * texels - centre));
  }
  return sum;
}

/// Compares 10^5 samples in [0, end] with their pdf. `draw(u)` returns a sample for a random number
/// in [0, 1). `density(x)` returns the pdf, which need not be normalised. `tests`: the number of
/// such comparisons in the calling test, for the Sidak correction.
template <class Draw, class Density>
void expect_density(double end, Draw draw, Density density, std::size_t tests) {
  std::vector<double> expected(kCells);
  double total = 0;
  for (int i = 0; i < kCells * kSteps; ++i) {
    const double value = density((i + 0.5) / (kCells * kSteps) * end);
    expected[static_cast<std::size_t>(i / kSteps)] += value;
    total += value;
  }
  std::vector<std::uint64_t> counts(kCells);
  Random random(1);
  for (int i = 0; i < kSamples; ++i) {
    const double x = draw(random.uniform());
    ASSERT_GE(x, 0);
    ASSERT_LE(x, end);
    ++counts[std::min<std::size_t>(kCells - 1, static_cast<std::size_t>(x / end * kCells))];
  }
  for (double& cell : expected) {
    cell *= kSamples / total;
  }
  EXPECT_GT(test::chi_squared(counts, expected).p_value, test::sidak(0.01, tests));
}

TEST(Tent, SamplesFollowLinearInterpolation) {
  struct Case {
    std::uint32_t index;
    std::uint32_t texels;
    Ends ends;
  };
  const std::vector<Case> cases = {{0, 5, Ends::kClamped}, {2, 5, Ends::kClamped},
                                   {4, 5, Ends::kClamped}, {0, 1, Ends::kClamped},
                                   {0, 5, Ends::kWrapped}, {4, 5, Ends::kWrapped},
                                   {0, 1, Ends::kWrapped}, {1, 2, Ends::kWrapped}};
  for (const Case& c : cases) {
    expect_density(
        c.texels, [&](double u) { return sample_tent(c.index, c.texels, c.ends, u); },
        [&](double x) { return tent(x, c.index, c.texels, c.ends); }, cases.size());
  }
}

TEST(Tent, SamplesInLatitudeFollowInterpolationTimesTheSine) {
  struct Case {
    std::uint32_t row;
    std::uint32_t rows;
  };
  const std::vector<Case> cases = {{0, 1},  {0, 2},  {1, 2},  {0, 10},  {1, 10},
                                   {5, 10}, {8, 10}, {9, 10}, {40, 100}};
  for (const Case& c : cases) {
    expect_density(
        kPi, [&](double v) { return sample_latitude_tent(c.row, c.rows, v); },
        [&](double theta) {
          return tent(theta * kInvPi * c.rows, c.row, c.rows, Ends::kClamped) * std::sin(theta);
        },
        cases.size());
  }
}

TEST(Tent, SolidAnglesOfAllRowsSumToTheSphere) {
  for (const std::uint32_t rows : {1u, 2u, 3u, 10u, 512u, 4096u, 65536u}) {
    double sum = 0;
    for (std::uint32_t row = 0; row < rows; ++row) {
      sum += latitude_tent_solid_angle(row, rows);
    }
    EXPECT_NEAR(sum / (4 * kPi), 1, 1e-7) << rows;
  }
}

TEST(Tent, TheSolidAngleOfARowIsTheIntegralOfItsTent) {
  for (const auto& [row, rows] :
       {std::pair(0u, 10u), std::pair(1u, 10u), std::pair(4u, 10u), std::pair(0u, 1000u)}) {
    constexpr int kFine = 200000;
    const double width = kPi / rows;
    // The tent covers three rows, or fewer if it is cut off at the pole.
    const double first = std::max(0.0, (row - 1.0) * width);
    const double step = ((row + 2.0) * width - first) / kFine;
    double sum = 0;
    for (int i = 0; i < kFine; ++i) {
      const double theta = first + (i + 0.5) * step;
      sum += tent(theta / width, row, rows, Ends::kClamped) * std::sin(theta) * step;
    }
    EXPECT_NEAR(latitude_tent_solid_angle(row, rows) / (2 * kPi * sum), 1, 1e-8);
  }
}

}  // namespace
}  // namespace bandsaw
