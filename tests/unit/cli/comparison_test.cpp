// The text and the numbers of `bandsaw compare`, which compares two images.

#include "coordinator/cli/image/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <utility>

namespace bandsaw::coordinator {
namespace {

Image image(std::uint32_t width, std::uint32_t height, float value) {
  Image out{.width = width, .height = height, .pixels = {}};
  out.pixels.assign(std::size_t{width} * height, gray(value));
  return out;
}

TEST(Comparison, EqualImagesAreIdentical) {
  const Comparison same = compare_images(image(3, 2, 0.5F), image(3, 2, 0.5F)).value();
  EXPECT_EQ(comparison_text(same), "identical");
  EXPECT_THAT(comparison_json(same), testing::HasSubstr("\"identical\":true"));
}

TEST(Comparison, ReportsTheMetricsOfTheDifference) {
  Image bad = image(32, 32, 0.5F);
  bad.pixels[5].g = 0.75F;
  const std::string text = comparison_text(compare_images(bad, image(32, 32, 0.5F)).value());
  // The images have 4 blocks of 16 x 16 pixels. A block is off if its difference is too large to be
  // noise.
  for (const char* part : {"RMSE", "relRMSE", "MAPE", "PSNR", "SSIM", "· FLIP",
                           "max difference 0.25 at pixel (5, 0)", "0 of 4 blocks off"}) {
    EXPECT_THAT(text, testing::HasSubstr(part));
  }
}

// If the reference, the second image, has values above 1, FLIP compares several exposures.
TEST(Comparison, ABrightReferenceIsSeenAtSeveralExposures) {
  EXPECT_FALSE(compare_images(image(8, 8, 5), image(8, 8, 1)).value().hdr);
  EXPECT_TRUE(compare_images(image(8, 8, 1), image(8, 8, 5)).value().hdr);
}

TEST(Comparison, NonFiniteValuesAreReported) {
  Image a = image(2, 1, 1);
  a.pixels[0].r = std::nanf("");
  EXPECT_THAT(comparison_text(compare_images(a, a).value()),
              testing::HasSubstr("1 value is not finite"));
}

// SSIM and FLIP count two values as equal if at least one of the two is not finite.
TEST(Comparison, NonFiniteValuesAreLeftOutOfAllMetrics) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Image good = image(32, 32, 0.5F);
  Image bad = good;
  for (std::size_t i = 0; i < 8; ++i) {
    bad.pixels[100 + i].g = std::nanf("");
    bad.pixels[200 + i].r = infinity;
  }
  for (const auto& [a, b] : {std::pair{bad, good}, {good, bad}, {bad, bad}}) {
    const Comparison comparison = compare_images(a, b).value();
    EXPECT_EQ(comparison.errors.not_finite, 16U);
    EXPECT_EQ(comparison.errors.rmse, 0);
    EXPECT_NEAR(comparison.ssim, 1, 1e-9);
    EXPECT_EQ(mean(comparison.flip), 0);
    EXPECT_FALSE(comparison.hdr);
  }
}

TEST(Comparison, DifferentSizesAreAnError) {
  EXPECT_EQ(compare_images(image(2, 3, 1), image(3, 2, 1)).status().message(),
            "the images differ in size: 2×3 and 3×2");
}

}  // namespace
}  // namespace bandsaw::coordinator
