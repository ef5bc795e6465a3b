// Error metrics between two images: RMSE, relative RMSE, relative MSE, MAPE (mean absolute
// percentage error) and PSNR. The trimmed relative MSE leaves out the worst thousandth of the
// pixels.

#include "renderlib/compare/error_metrics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/unit/compare/pictures.h"

namespace bandsaw::test {
namespace {

TEST(ErrorMetrics, EqualImagesAreIdentical) {
  const ErrorMetrics metrics = error_metrics(uniform(3, 2, 0.5F), uniform(3, 2, 0.5F));
  EXPECT_TRUE(metrics.identical);
  EXPECT_EQ(metrics.rmse, 0);
  EXPECT_EQ(metrics.mape, 0);
  EXPECT_EQ(metrics.psnr, std::numeric_limits<double>::infinity());
}

// The reference is 0.5. relMSE is the square of the difference divided by 0.5^2 + 0.01, and MAPE is
// the difference divided by 0.5 + 0.01.
TEST(ErrorMetrics, TheRmseOfAConstantDifferenceIsTheDifference) {
  const ErrorMetrics metrics = error_metrics(uniform(4, 4, 0.75F), uniform(4, 4, 0.5F));
  EXPECT_FALSE(metrics.identical);
  EXPECT_DOUBLE_EQ(metrics.rmse, 0.25);
  EXPECT_DOUBLE_EQ(metrics.relative_rmse, 0.5);
  EXPECT_NEAR(metrics.relative_mse, 0.0625 / (0.25 + 0.01), 1e-15);
  EXPECT_NEAR(metrics.mape, 0.25 / 0.51, 1e-15);
  EXPECT_DOUBLE_EQ(metrics.max_difference, 0.25);
}

// The sRGB code of linear 1 is 1. Near 0 the curve is linear with the slope 12.92, so the code of
// 0.001 is 0.01292. Values above 1 are clamped.
TEST(ErrorMetrics, PeakSignalToNoiseComparesSrgbCodes) {
  EXPECT_NEAR(error_metrics(uniform(2, 2, 1), uniform(2, 2, 0)).psnr, 0, 1e-12);
  EXPECT_NEAR(error_metrics(uniform(2, 2, 0.001F), uniform(2, 2, 0)).psnr,
              -20 * std::log10(0.01292), 1e-5);
  EXPECT_NEAR(error_metrics(uniform(2, 2, 9), uniform(2, 2, 0)).psnr, 0, 1e-12);
}

TEST(ErrorMetrics, ADifferenceInOneChannelOfOnePixelIsFound) {
  Image a = uniform(4, 3, 1);
  a.pixels[2 * 4 + 1].g = 4;
  const ErrorMetrics metrics = error_metrics(a, uniform(4, 3, 1));
  EXPECT_DOUBLE_EQ(metrics.rmse, std::sqrt(9.0 / 36));
  EXPECT_EQ(metrics.max_difference, 3);
  EXPECT_EQ(metrics.max_x, 1u);
  EXPECT_EQ(metrics.max_y, 2u);
}

// The image has 2,000 pixels, so the worst two are left out. The other 1,998 pixels have 5,994
// values. One of these values differs by 1 from the reference, which is 1, so its relative squared
// error is 1 / (1 + 0.01).
TEST(ErrorMetrics, TrimmingLeavesOutTheWorstThousandth) {
  Image a = uniform(50, 40, 1);
  a.pixels[7].r = 100;
  a.pixels[1234] = gray(50);
  EXPECT_EQ(error_metrics(a, uniform(50, 40, 1)).trimmed_relative_mse, 0);
  a.pixels[9].b = 2;
  EXPECT_NEAR(error_metrics(a, uniform(50, 40, 1)).trimmed_relative_mse, 1 / 1.01 / 5994, 1e-12);
}

TEST(ErrorMetrics, AnImageOfOnePixelIsNotTrimmedAway) {
  const ErrorMetrics metrics = error_metrics(uniform(1, 1, 2), uniform(1, 1, 1));
  EXPECT_EQ(metrics.trimmed_relative_mse, metrics.relative_mse);
  EXPECT_GT(metrics.relative_mse, 0.9);
}

TEST(ErrorMetrics, MetricsAreNanIfNoPixelIsFinite) {
  const ErrorMetrics metrics = error_metrics(uniform(3, 2, std::nanf("")), uniform(3, 2, 1));
  EXPECT_EQ(metrics.not_finite, 18u);  // three values of each of the six pixels
  EXPECT_TRUE(std::isnan(metrics.rmse));
  EXPECT_TRUE(std::isnan(metrics.relative_mse));
  EXPECT_FALSE(metrics.identical);
}

TEST(ErrorMetrics, RelativeRmseOfABlackReferenceIsInfiniteOrZero) {
  EXPECT_EQ(error_metrics(uniform(1, 1, 1), uniform(1, 1, 0)).relative_rmse,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(error_metrics(uniform(1, 1, 0), uniform(1, 1, 0)).relative_rmse, 0);
}

TEST(ErrorMetrics, ValuesThatAreNotFiniteAreCountedAndNeverIdentical) {
  Image a = uniform(2, 1, 1);
  a.pixels[0].r = std::nanf("");
  const ErrorMetrics metrics = error_metrics(a, a);
  EXPECT_FALSE(metrics.identical);
  EXPECT_EQ(metrics.not_finite, 1u);
  EXPECT_EQ(metrics.rmse, 0);
}

}  // namespace
}  // namespace bandsaw::test
