// The text and the numbers of `bandsaw compare`, which compares two images.

#include "coordinator/cli/image/comparison.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

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
              testing::HasSubstr("1 values are not finite"));
}

TEST(Comparison, DifferentSizesAreAnError) {
  EXPECT_EQ(compare_images(image(2, 3, 1), image(3, 2, 1)).status().message(),
            "the images differ in size: 2×3 and 3×2");
}

}  // namespace
}  // namespace bandsaw::coordinator
