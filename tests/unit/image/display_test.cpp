// The conversion of linear light for display: exposure and tone curve.

#include "renderlib/image/display.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderlib/image/write_image.h"

namespace bandsaw {
namespace {

TEST(Display, TheDefaultChangesNothing) {
  const Rgb any{-1, 3e38f, 0.1f};
  EXPECT_EQ(shown(any, {}), any);
}

TEST(Display, OneStopDoublesTheLight) {
  EXPECT_EQ(shown({0.25f, 1, 0}, {.exposure = 2}), (Rgb{1, 4, 0}));
  EXPECT_EQ(shown({0.25f, 1, 0}, {.exposure = -1}), (Rgb{0.125f, 0.5f, 0}));
}

TEST(Display, FilmicRisesFromBlackToWhite) {
  const Display filmic{.tone = Tone::kFilmic};
  EXPECT_EQ(shown({0, -2, std::numeric_limits<float>::infinity()}, filmic), (Rgb{0, 0, 1}));
  // The expected values were computed by the formula (image/display.h) in exact arithmetic.
  EXPECT_NEAR(shown(gray(0.18f), filmic).r, 0.266895, 1e-5);
  EXPECT_NEAR(shown(gray(1), filmic).r, 2.54 / 3.16, 1e-6);
  float before = 0;
  for (float x = 0.001f; x < 100; x *= 1.1f) {
    const float now = shown(gray(x), filmic).g;
    EXPECT_GE(now, before);
    before = now;
  }
  EXPECT_EQ(before, 1);
}

TEST(Display, NanStaysNan) {
  const Rgb none = gray(std::numeric_limits<float>::quiet_NaN());
  EXPECT_TRUE(std::isnan(shown(none, {.exposure = 1, .tone = Tone::kFilmic}).g));
}

TEST(Display, AppliesToEightBitFilesOnly) {
  const Image image{.width = 1, .height = 1, .pixels = {{0.1f, 0.2f, 0.4f}}};
  const Display display{.exposure = 1, .tone = Tone::kFilmic};
  for (const ImageFormat format : {ImageFormat::kPfm, ImageFormat::kHdr, ImageFormat::kExr}) {
    EXPECT_EQ(*encode_image(image, format, display), *encode_image(image, format));
  }
  for (const ImageFormat format : {ImageFormat::kPng, ImageFormat::kPpm}) {
    EXPECT_NE(*encode_image(image, format, display), *encode_image(image, format));
  }
}

}  // namespace
}  // namespace bandsaw
