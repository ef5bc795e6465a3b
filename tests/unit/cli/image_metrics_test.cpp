#include "coordinator/cli/image_metrics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace bandsaw::coordinator {
namespace {

Image image(std::uint32_t width, std::uint32_t height, float value) {
  Image out{.width = width, .height = height, .pixels = {}};
  out.pixels.assign(std::size_t{width} * height, gray(value));
  return out;
}

TEST(ImageMetrics, EqualImagesAreIdentical) {
  const ImageMetrics metrics = compare_images(image(3, 2, 0.5F), image(3, 2, 0.5F)).value();
  EXPECT_TRUE(metrics.identical);
  EXPECT_EQ(metrics.rmse, 0);
  EXPECT_EQ(metrics_text(metrics), "identical");
}

TEST(ImageMetrics, AConstantDifferenceIsItsOwnRmse) {
  const ImageMetrics metrics = compare_images(image(4, 4, 0.75F), image(4, 4, 0.5F)).value();
  EXPECT_FALSE(metrics.identical);
  EXPECT_DOUBLE_EQ(metrics.rmse, 0.25);
  EXPECT_DOUBLE_EQ(metrics.relative_rmse, 0.5);
  EXPECT_NEAR(metrics.relative_mse, 0.0625 / (0.25 + 0.01), 1e-15);
  EXPECT_DOUBLE_EQ(metrics.max_difference, 0.25);
}

TEST(ImageMetrics, OneChannelOfOnePixelIsFound) {
  Image a = image(4, 3, 1);
  a.pixels[2 * 4 + 1].g = 4;
  const ImageMetrics metrics = compare_images(a, image(4, 3, 1)).value();
  EXPECT_DOUBLE_EQ(metrics.rmse, std::sqrt(9.0 / 36));
  EXPECT_EQ(metrics.max_difference, 3);
  EXPECT_EQ(metrics.max_x, 1u);
  EXPECT_EQ(metrics.max_y, 2u);
}

TEST(ImageMetrics, ABlackReferenceGivesNoRatio) {
  EXPECT_EQ(compare_images(image(1, 1, 1), image(1, 1, 0)).value().relative_rmse,
            std::numeric_limits<double>::infinity());
  EXPECT_EQ(compare_images(image(1, 1, 0), image(1, 1, 0)).value().relative_rmse, 0);
}

TEST(ImageMetrics, ValuesThatAreNotFiniteAreCountedAndNeverIdentical) {
  Image a = image(2, 1, 1);
  a.pixels[0].r = std::nanf("");
  const ImageMetrics metrics = compare_images(a, a).value();
  EXPECT_FALSE(metrics.identical);
  EXPECT_EQ(metrics.not_finite, 1u);
  EXPECT_EQ(metrics.rmse, 0);
  EXPECT_THAT(metrics_text(metrics), testing::HasSubstr("1 values are not finite"));
}

TEST(ImageMetrics, DifferentSizesAreAnError) {
  EXPECT_EQ(compare_images(image(2, 3, 1), image(3, 2, 1)).status().message(),
            "the images differ in size: 2×3 and 3×2");
}

}  // namespace
}  // namespace bandsaw::coordinator
