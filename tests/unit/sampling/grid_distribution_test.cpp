// Selection of a cell of a grid, with a probability proportional to the weight of the cell. An id
// such as L7 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/sampling/grid_distribution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderlib/math/constants.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

TEST(GridDistribution, CellsAreSelectedByTheirWeight) {
  constexpr std::uint32_t kWidth = 7;
  constexpr std::uint32_t kHeight = 5;
  const auto weight = [](std::uint32_t x, std::uint32_t y) {
    return y == 2 || (x + y) % 3 == 0 ? 0.0 : std::exp2(static_cast<double>(x) - y);
  };
  const GridDistribution grid(kWidth, kHeight, weight);
  constexpr int kSamples = 200000;
  test::Random random(3);
  std::vector<std::uint64_t> counts(kWidth * kHeight);
  std::vector<double> expected;
  double sum = 0;
  for (std::uint32_t y = 0; y < kHeight; ++y) {
    for (std::uint32_t x = 0; x < kWidth; ++x) {
      expected.push_back(weight(x, y) / grid.total() * kSamples);
      sum += weight(x, y);
    }
  }
  EXPECT_DOUBLE_EQ(grid.total(), sum);
  test::Moments remaining_u;
  for (int i = 0; i < kSamples; ++i) {
    const double u = random.uniform();
    const auto cell = grid.sample(u, random.uniform());
    ASSERT_GT(weight(cell.column, cell.row), 0);
    ASSERT_TRUE(cell.u >= 0 && cell.u < 1 && cell.v >= 0 && cell.v < 1);
    remaining_u.add(cell.u);
    ++counts[cell.row * kWidth + cell.column];
  }
  EXPECT_GT(test::chi_squared(counts, expected).p_value, 0.01);
  EXPECT_LE(std::abs(remaining_u.z(0.5)), 4)
      << "the remainder of the random number must be uniform";
}

// The tail, columns 1 to 999, has 1e-12 of the weight. The largest random number selects a cell of
// the tail.
TEST(GridDistribution, L7_ATailOfSmallWeightsIsSampled) {
  const GridDistribution grid(1000, 1,
                              [](std::uint32_t x, std::uint32_t) { return x == 0 ? 1e9 : 1e-6; });
  const auto last = grid.sample(kOneMinusEpsilon, kOneMinusEpsilon);
  EXPECT_GT(last.column, 0u);
}

TEST(GridDistribution, ExtremeWeightsAndRandomNumbersSelectTheOnlyCell) {
  for (const double scale : {1e-300, 1.0, 1e200}) {
    const GridDistribution grid(
        3, 3, [&](std::uint32_t x, std::uint32_t y) { return x == 1 && y == 1 ? scale : 0.0; });
    for (const double u : {0.0, 0.5, kOneMinusEpsilon}) {
      const auto cell = grid.sample(u, u);
      EXPECT_EQ(cell.column, 1u);
      EXPECT_EQ(cell.row, 1u);
      EXPECT_LT(cell.u, 1);
    }
  }
  EXPECT_EQ(GridDistribution().total(), 0);
}

}  // namespace
}  // namespace bandsaw
