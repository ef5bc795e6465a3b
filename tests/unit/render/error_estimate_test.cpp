#include "renderlib/render/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bandsaw::test {
namespace {

// A row of gray pixels whose two halves of 16 samples have the means value +- error.
struct Row {
  std::vector<double> first;
  std::vector<double> second;

  void add(double value, double error) {
    first.insert(first.end(), 3, 16 * (value + error));
    second.insert(second.end(), 3, 16 * (value - error));
  }
  ErrorEstimate estimate(std::size_t step = 2) const {
    ErrorSums sums;
    const NodeSums nodes[] = {{16, first}, {16, second}};
    sums.add_row(nodes, step);
    return sums.estimate();
  }
};

TEST(ErrorEstimate, IsHalfTheDifferenceBetweenTheHalves) {
  Row row;
  row.add(2, 0.1);
  row.add(2, 0.1);
  const ErrorEstimate error = row.estimate();
  EXPECT_DOUBLE_EQ(error.mean, 2);
  EXPECT_NEAR(error.rmse, 0.1, 1e-12);
  EXPECT_NEAR(error.relative_rmse, 0.05, 1e-12);
  EXPECT_NEAR(error.relative_mse, 0.01 / 4.01, 1e-12);
}

double square_at_most(const ErrorEstimate& error) {
  const double over = error.at_most() / error.relative_rmse;
  return over * over;
}

// The margin is three standard deviations of a sum of n equal squares: sqrt(1.5 n) times one of
// them.
TEST(ErrorEstimate, TheMarginGrowsWithFewerHalfRows) {
  for (const std::size_t decide : {3, 150}) {
    Row one_pixel;  // one pixel in each of so many half rows,
    Row all;        // or all eight pixels, which may have the same error
    for (std::size_t x = 0; x < 2400; ++x) {
      const bool noisy = x / 16 < decide && x % 2 == 0;
      one_pixel.add(1, noisy && x % 16 == 4 ? 0.1 : 0);
      all.add(1, noisy ? 0.1 : 0);
    }
    const double expected = 1 + 3 * std::sqrt(1.5 / static_cast<double>(decide));
    EXPECT_NEAR(square_at_most(one_pixel.estimate()), expected, 1e-9) << decide;
    EXPECT_NEAR(square_at_most(all.estimate()), expected, 1e-9) << decide;
  }
}

TEST(ErrorEstimate, ASingleHalfRowCountsAsEightPixels) {
  Row row;
  for (int x = 0; x < 80; ++x) {
    row.add(1, 0.1);
  }
  EXPECT_NEAR(square_at_most(row.estimate(1)), 1 + 3 * std::sqrt(1.5 / 10), 1e-9);
  EXPECT_NEAR(square_at_most(row.estimate(2)), 1 + 3 * std::sqrt(1.5 / 10), 1e-9);
}

TEST(ErrorEstimate, ADominantPixelMakesItUncertain) {
  Row even;
  Row uneven;
  for (int i = 0; i < 2000; ++i) {
    even.add(1, 0.1);
    uneven.add(1, i == 5 ? 10 : 0.1);
  }
  EXPECT_NEAR(even.estimate().worst_share, 0.001, 1e-9);
  EXPECT_FALSE(even.estimate().doubtful());
  EXPECT_NEAR(uneven.estimate().worst_share, (100 + 0.01) / (100 + 0.01 * 1999), 1e-6);
  EXPECT_TRUE(uneven.estimate().doubtful());
}

TEST(ErrorEstimate, PercentilesAreOfThePixelsOwnErrors) {
  Row row;
  for (int i = 0; i < 1001; ++i) {
    row.add(1, i / 1000.0);
  }
  const ErrorEstimate error = row.estimate();
  EXPECT_NEAR(error.median, 0.5 / 1.01, 1e-6);
  EXPECT_NEAR(error.percentile_95, 0.95 / 1.01, 1e-6);
  EXPECT_NEAR(error.percentile_99, 0.99 / 1.01, 1e-6);
}

TEST(ErrorEstimate, IsKnownForBlackWithManySamples) {
  Row row;
  row.add(0, 0);
  EXPECT_LT(known_error(row.estimate(), kBlackSamples - 1), 0);
  EXPECT_EQ(known_error(row.estimate(), kBlackSamples), 0);
  EXPECT_LT(known_error(std::nullopt, 1 << 20), 0);
}

TEST(ErrorEstimate, BlackIsCertain) {
  Row row;
  row.add(0, 0);
  const ErrorEstimate error = row.estimate();
  EXPECT_EQ(error.relative_rmse, 0);
  EXPECT_EQ(error.margin, 0);
  EXPECT_EQ(error.percentile_99, 0);
  EXPECT_EQ(error.worst_share, 0);
}

// A further node that agrees with the halves lowers the error according to its samples; one that
// differs much raises it.
TEST(ErrorEstimate, FurtherNodesCount) {
  const std::vector<double> a(3, 16 * 1.1);
  const std::vector<double> b(3, 16 * 0.9);
  const auto with = [&](double mean) {
    const std::vector<double> c(3, 16 * mean);
    ErrorSums sums;
    const NodeSums nodes[] = {{16, a}, {16, b}, {16, c}};
    sums.add_row(nodes, 2);
    return sums.estimate().rmse;
  };
  EXPECT_NEAR(with(1.1), std::sqrt((4 * 0.01 + (0.01 - 0.01)) / 9), 1e-12);
  EXPECT_NEAR(with(2), std::sqrt((4 * 0.01 + (1 - 0.01)) / 9), 1e-12);
}

}  // namespace
}  // namespace bandsaw::test
