// Perceptual metrics, FLIP and SSIM, against closed forms. The file also tests the
// conversions of colours that the metrics use, and the false colours that show errors.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderlib/compare/false_color.h"
#include "renderlib/compare/flip.h"
#include "renderlib/compare/flip_parts.h"
#include "renderlib/compare/perceived.h"
#include "renderlib/compare/ssim.h"
#include "renderlib/image/srgb.h"
#include "tests/unit/compare/pictures.h"

namespace bandsaw::test {
namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

// The expected values are those published for white and the primaries of sRGB.
TEST(Perceived, LabOfThePrimariesHasThePublishedValues) {
  expect_near(lab(xyz_over_white({1, 1, 1})), {100, 0, 0}, 1e-9);
  expect_near(lab(xyz_over_white({1, 0, 0})), {53.24, 80.09, 67.20}, 0.05);
  expect_near(lab(xyz_over_white({0, 1, 0})), {87.74, -86.18, 83.18}, 0.05);
  expect_near(lab(xyz_over_white({0, 0, 1})), {32.30, 79.19, -107.86}, 0.05);
}

TEST(Perceived, ConvertingToOpponentColoursAndBackKeepsTheColour) {
  const Rgb color{0.1F, 0.7F, 0.4F};
  expect_near(linear_of(xyz_of_opponents(opponents(xyz_over_white(color)))),
              {color.r, color.g, color.b}, 1e-12);
}

TEST(Flip, EqualImagesDoNotDiffer) {
  EXPECT_EQ(mean(flip(waves(40, 30), waves(40, 30))), 0);
  EXPECT_EQ(mean(hdr_flip(waves(40, 30), waves(40, 30))), 0);
}

// The expected value follows from equations 7 to 9 of Andersson et al. 2020 (compare/flip.h). The
// images have no edges, so their features do not differ. The HyAB distance of black and white is
// 100. The largest distance, which is that of green and blue, is 203.3.
TEST(Flip, BlackAgainstWhiteEqualsTheClosedForm) {
  const double largest = std::pow(203.31, 0.7);
  const double expected = 0.95 + 0.05 * (std::pow(100, 0.7) - 0.4 * largest) / (0.6 * largest);
  const Plane error = flip(uniform(30, 30, 0), uniform(30, 30, 1));
  for (const double value : error.values) {
    EXPECT_NEAR(value, expected, 1e-4);
  }
  EXPECT_NEAR(expected, 0.9674, 1e-4);
}

TEST(Flip, GreenAgainstBlueHasTheLargestError) {
  const Image green = uniform(30, 30, Rgb{0, 1, 0});
  EXPECT_NEAR(mean(flip(green, uniform(30, 30, Rgb{0, 0, 1}))), 1, 1e-9);
}

TEST(Flip, IsSymmetricAndGrowsWithTheDifference) {
  const Image a = waves(40, 30);
  Image b = a;
  double last = 0;
  for (const float shift : {0.01F, 0.05F, 0.2F}) {
    for (std::size_t i = 0; i < b.pixels.size(); ++i) {
      b.pixels[i] = a.pixels[i] + gray(shift);
    }
    const double error = mean(flip(b, a));
    EXPECT_NEAR(error, mean(flip(a, b)), 1e-12);
    EXPECT_GT(error, last);
    last = error;
  }
}

// FLIP detects edges with a filter that responds to a step with the step's height (equations 11 and
// 12 of Andersson et al. 2020). The step has the height 0.2, so the feature difference at the step
// is sqrt(0.2 / sqrt(2)). It raises the error beside the step, although the colours beside the step
// differ no more than the colours far from it.
TEST(Flip, TheErrorBesideAMissingEdgeIsLargerThanFarFromIt) {
  Image edge = uniform(60, 60, 0.3F);
  for (std::size_t i = 0; i < edge.pixels.size(); ++i) {
    edge.pixels[i] = i % 60 < 30 ? gray(0.3F) : gray(0.5F);
  }
  const Image flat = uniform(60, 60, 0.4F);
  EXPECT_NEAR(flip_features(edge, flat, kPixelsPerDegree).values[30 * 60 + 30],
              std::sqrt(0.2 / std::sqrt(2.0)), 1e-6);
  const Plane error = flip(edge, flat);
  EXPECT_GT(error.values[30 * 60 + 34], 1.1 * error.values[30 * 60 + 50]);
}

// A highlight that is brighter than a screen can show is clamped by flip(), so a difference in it
// is not seen. hdr_flip() also compares the images at lower exposures, at which the difference is
// seen.
TEST(Flip, HdrFlipSeesDifferencesInHighlights) {
  Image a = uniform(40, 40, 0.1F);
  Image b = a;
  for (std::size_t i = 0; i < 400; ++i) {
    a.pixels[i] = gray(50);
    b.pixels[i] = gray(5);
  }
  EXPECT_LT(mean(flip(a, b)), 1e-9);
  EXPECT_GT(mean(hdr_flip(a, b)), 0.05);
  EXPECT_TRUE(beyond_screen(a));
  EXPECT_FALSE(beyond_screen(uniform(2, 2, 1)));
}

TEST(Ssim, UniformImagesEqualTheClosedForm) {
  const double a = srgb_curve(0.2F);
  const double b = srgb_curve(0.6F);
  EXPECT_NEAR(ssim(uniform(20, 20, 0.2F), uniform(20, 20, 0.6F)),
              (2 * a * b + 1e-4) / (a * a + b * b + 1e-4), 1e-7);
}

TEST(Ssim, EqualImagesGiveOneAndInvertedImagesLessThanZero) {
  const Image a = waves(40, 30);
  EXPECT_NEAR(ssim(a, a), 1, 1e-12);
  Image inverted = a;
  for (Rgb& pixel : inverted.pixels) {
    pixel = gray(1 - pixel.r);
  }
  EXPECT_LT(ssim(a, inverted), 0);
}

TEST(FalseColor, LightGrowsFromBlackToNearlyWhite) {
  Plane ramp(101, 1);
  for (int i = 0; i <= 100; ++i) {
    ramp.values[static_cast<std::size_t>(i)] = i / 100.0;
  }
  const Image image = false_color(ramp);
  EXPECT_EQ(image.pixels[0], gray(0));
  EXPECT_GT(luminance(image.pixels[100]), 0.9F);
  for (std::size_t i = 1; i < 101; ++i) {
    EXPECT_GT(luminance(image.pixels[i]), luminance(image.pixels[i - 1])) << i;
  }
}

// An infinitely bright light that is missing in the reference counts as much as a very bright one.
TEST(Flip, AnInfiniteValueCountsAsVeryBright) {
  Image reference = uniform(32, 32, 0);
  reference.pixels[0] = gray(2);
  Image bright = reference;
  bright.pixels[500] = gray(1e30F);
  Image infinite = reference;
  infinite.pixels[500] = gray(std::numeric_limits<float>::infinity());
  EXPECT_GT(mean(hdr_flip(infinite, reference)), 1e-3);
  EXPECT_EQ(mean(hdr_flip(infinite, reference)), mean(hdr_flip(bright, reference)));
}

}  // namespace
}  // namespace bandsaw::test
