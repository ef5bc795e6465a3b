// The contact sheet of a sequence: one picture with a small image of each frame and its number.

#include "coordinator/cli/image/contact_sheet.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bandsaw::coordinator {
namespace {

/// Returns an image with one value in all pixels.
Image flat(std::uint32_t width, std::uint32_t height, const Rgb& value) {
  return {width, height, std::vector<Rgb>(std::size_t{width} * height, value)};
}

/// Returns the number of pixels that have this value.
std::size_t count(const Image& image, const Rgb& value) {
  return static_cast<std::size_t>(
      std::count_if(image.pixels.begin(), image.pixels.end(), [&](const Rgb& pixel) {
        return pixel.r == value.r && pixel.g == value.g && pixel.b == value.b;
      }));
}

TEST(ContactSheet, ShowsEachFrameOnceAndCrossesOutMissingOnes) {
  const Rgb red{0.75f, 0, 0};
  const Rgb green{0, 0.5f, 0};
  ContactSheet sheet({-1, 2, 10}, 40, 30);
  sheet.add(-1, flat(40, 30, red), {});
  sheet.add(10, flat(40, 30, green), {});
  sheet.add(11, flat(40, 30, green), {});  // the sheet has no frame 11
  const Image picture = sheet.picture();
  EXPECT_EQ(picture.pixels.size(), std::size_t{picture.width} * picture.height);
  EXPECT_EQ(count(picture, red), 40u * 30);
  EXPECT_EQ(count(picture, green), 40u * 30);
  // The labels are -1, 2 and 10. They are drawn with dots of 2 x 2 pixels. The digit 1 has 8 dots,
  // the digit 2 has 11, the digit 0 has 12, and the minus sign has 3.
  const Rgb ink{0.6f, 0.6f, 0.6f};
  const std::size_t cross = 2 * 30;  // two diagonals, each with a pixel in every row of a cell
  EXPECT_NEAR(static_cast<double>(count(picture, ink)), 4 * (3 + 8 + 11 + 8 + 12) + cross, 4);
}

TEST(ContactSheet, AppliesTheExposureOfTheFrame) {
  ContactSheet sheet({1}, 8, 8);
  sheet.add(1, flat(8, 8, {0.125f, 0.125f, 0.125f}), {.exposure = 2});
  EXPECT_EQ(count(sheet.picture(), {0.5f, 0.5f, 0.5f}), 64u);
}

TEST(ContactSheet, ShowsSomeOfManyFramesAtEqualDistancesInABoundedPicture) {
  std::vector<std::int64_t> numbers;
  for (std::int64_t i = 0; i < 10'000; ++i) {
    numbers.push_back(i);
  }
  ContactSheet sheet(numbers, 1'920, 1'080);
  const auto shown = static_cast<std::size_t>(std::count_if(
      numbers.begin(), numbers.end(), [&](std::int64_t number) { return sheet.shows(number); }));
  EXPECT_EQ(shown, kMaxSheetFrames);
  EXPECT_TRUE(sheet.shows(0));
  EXPECT_TRUE(sheet.shows(9'999));
  const Image picture = sheet.picture();
  EXPECT_LE(picture.width, 2'000u);
  EXPECT_LE(picture.height, 2'000u);
}

}  // namespace
}  // namespace bandsaw::coordinator
