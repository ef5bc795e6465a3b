// The estimate of an image's error from the difference between two halves of its samples, and the
// margin by which the error may be larger (ErrorEstimate::at_most). A group is eight pixels that
// share paths, so their errors are not independent. A node is a range of samples whose sum is
// known.

#include "renderlib/render/error_estimate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace bandsaw::test {
namespace {

// Gray pixels whose two halves of 16 samples have the means value + error and value - error.
class Pixels {
 public:
  void add(double value, double error) {
    const double first[] = {16 * (value + error), 16 * (value + error), 16 * (value + error)};
    const double second[] = {16 * (value - error), 16 * (value - error), 16 * (value - error)};
    const NodeSums nodes[] = {{16, first}, {16, second}};
    sums_.add(nodes);
  }
  void end_group() { sums_.end_group(); }
  ErrorEstimate estimate() {
    end_group();
    return sums_.estimate();
  }

 private:
  ErrorSums sums_;
};

// relative_mse is the mean of error^2 / (value^2 + 0.01).
TEST(ErrorEstimate, IsHalfTheDifferenceBetweenTheHalves) {
  Pixels pixels;
  pixels.add(2, 0.1);
  pixels.add(2, 0.1);
  const ErrorEstimate error = pixels.estimate();
  EXPECT_DOUBLE_EQ(error.mean, 2);
  EXPECT_NEAR(error.rmse, 0.1, 1e-12);
  EXPECT_NEAR(error.relative_rmse, 0.05, 1e-12);
  EXPECT_NEAR(error.relative_mse, 0.01 / 4.01, 1e-12);
}

/// Returns the square of at_most() / relative_rmse.
double square_at_most(const ErrorEstimate& error) {
  const double over = error.at_most() / error.relative_rmse;
  return over * over;
}

// Only n = `noisy_groups` groups have an error, and each has the same squared error e. The margin
// assumes that their sum, n e, has a standard deviation of sqrt(1.5 n) e, and adds three standard
// deviations to the sum. The bound is the same whether one pixel of a group has the error or all
// eight.
TEST(ErrorEstimate, TheMarginGrowsWithFewerGroups) {
  for (const int noisy_groups : {3, 150}) {
    Pixels one_pixel;  // one pixel of each noisy group has an error
    Pixels all;        // all eight pixels of each noisy group have the same error
    for (int i = 0; i < 2400; ++i) {
      const bool noisy = i / 8 < noisy_groups;
      one_pixel.add(1, noisy && i % 8 == 4 ? 0.1 : 0);
      all.add(1, noisy ? 0.1 : 0);
      if (i % 8 == 7) {
        one_pixel.end_group();
        all.end_group();
      }
    }
    const double expected = 1 + 3 * std::sqrt(1.5 / noisy_groups);
    EXPECT_NEAR(square_at_most(one_pixel.estimate()), expected, 1e-9) << noisy_groups;
    EXPECT_NEAR(square_at_most(all.estimate()), expected, 1e-9) << noisy_groups;
  }
}

// `worst_share` is the share of the worst thousandth of the pixels, here two, in the sum of the
// squared errors.
TEST(ErrorEstimate, ADominantPixelMakesTheEstimateDoubtful) {
  Pixels even;
  Pixels uneven;
  for (int i = 0; i < 2000; ++i) {
    even.add(1, 0.1);
    uneven.add(1, i == 5 ? 10 : 0.1);
  }
  EXPECT_NEAR(even.estimate().worst_share, 0.001, 1e-9);
  EXPECT_FALSE(even.estimate().doubtful());
  EXPECT_NEAR(uneven.estimate().worst_share, (100 + 0.01) / (100 + 0.01 * 1999), 1e-6);
  EXPECT_TRUE(uneven.estimate().doubtful());
}

// Each pixel's error is divided by the pixel's value plus a hundredth of the mean, here 1.01.
TEST(ErrorEstimate, PercentilesAreOfThePixelsOwnErrors) {
  Pixels pixels;
  for (int i = 0; i < 1001; ++i) {
    pixels.add(1, i / 1000.0);
  }
  const ErrorEstimate error = pixels.estimate();
  EXPECT_NEAR(error.median, 0.5 / 1.01, 1e-6);
  EXPECT_NEAR(error.percentile_95, 0.95 / 1.01, 1e-6);
  EXPECT_NEAR(error.percentile_99, 0.99 / 1.01, 1e-6);
}

// known_error() returns a negative number if the error is not known. A black image with few samples
// may only have missed its light.
TEST(ErrorEstimate, IsKnownForABlackImageOfManySamples) {
  Pixels pixels;
  pixels.add(0, 0);
  EXPECT_LT(known_error(pixels.estimate(), kBlackSamples - 1), 0);
  EXPECT_EQ(known_error(pixels.estimate(), kBlackSamples), 0);
  EXPECT_LT(known_error(std::nullopt, 1 << 20), 0);
}

TEST(ErrorEstimate, ABlackImageHasNoError) {
  Pixels pixels;
  pixels.add(0, 0);
  const ErrorEstimate error = pixels.estimate();
  EXPECT_EQ(error.relative_rmse, 0);
  EXPECT_EQ(error.margin, 0);
  EXPECT_EQ(error.percentile_99, 0);
  EXPECT_EQ(error.worst_share, 0);
}

// All nodes have 16 samples. The first two have the means 1.1 and 0.9. So their common mean is 1,
// and ErrorSums::add() estimates its variance by v = ((1.1 - 0.9) / 2)^2 = 0.01. It estimates the
// variance of a third node of mean m by (m - 1)^2 - v. The mean of all samples has 2/3 of its
// weight from the first two nodes and 1/3 from the third, so its variance is (2^2 * v + 1^2 * ((m -
// 1)^2 - v)) / 3^2. The error is the square root of this variance.
TEST(ErrorEstimate, TheErrorGrowsWithTheDifferenceOfAThirdNodeFromTheMean) {
  const std::vector<double> a(3, 16 * 1.1);
  const std::vector<double> b(3, 16 * 0.9);
  const auto with = [&](double mean) {
    const std::vector<double> c(3, 16 * mean);
    ErrorSums sums;
    const NodeSums nodes[] = {{16, a}, {16, b}, {16, c}};
    sums.add(nodes);
    sums.end_group();
    return sums.estimate().rmse;
  };
  EXPECT_NEAR(with(1.1), std::sqrt((4 * 0.01 + (0.01 - 0.01)) / 9), 1e-12);
  EXPECT_NEAR(with(2), std::sqrt((4 * 0.01 + (1 - 0.01)) / 9), 1e-12);
}

}  // namespace
}  // namespace bandsaw::test
