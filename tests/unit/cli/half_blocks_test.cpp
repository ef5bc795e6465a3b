// Images in a terminal: each character cell shows two pixels, one above the other, by the character
// U+2580 with two colours. The last argument of half_blocks() is the largest number of columns and
// of lines.

#include "coordinator/cli/progress/half_blocks.h"

#include <gmock/gmock.h>

#include <limits>

#include "coordinator/cli/base/text.h"

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr Rgb kBlack{};
constexpr Rgb kWhite{1, 1, 1};
constexpr Rgb kRed{1, 0, 0};

/// Returns the line without its escape sequences.
std::string plain(const std::string& line) {
  std::string out;
  bool inside = false;
  for (const char c : line) {
    inside = inside || c == '\x1b';
    if (!inside) {
      out += c;
    }
    inside = inside && c != 'm';
  }
  return out;
}

TEST(HalfBlocks, TheUpperPixelIsTheForegroundAndTheLowerOneTheBackground) {
  const Image image{2, 2, {kWhite, kRed, kBlack, kRed}};
  EXPECT_THAT(half_blocks(image, {}, {80, 24}),
              ElementsAre("\x1b[38;2;255;255;255m\x1b[48;2;0;0;0m▀"
                          "\x1b[38;2;255;0;0m\x1b[48;2;255;0;0m▀\x1b[0m"));
}

TEST(HalfBlocks, TheLastOfAnOddNumberOfRowsHasNoBackground) {
  const Image image{1, 3, {kWhite, kWhite, kRed}};
  EXPECT_THAT(half_blocks(image, {}, {80, 24}),
              ElementsAre("\x1b[38;2;255;255;255m\x1b[48;2;255;255;255m▀\x1b[0m",
                          "\x1b[38;2;255;0;0m▀\x1b[0m"));
}

TEST(HalfBlocks, FitsTheSpaceAndKeepsItsAspectRatio) {
  Image image{600, 300, {}};
  image.pixels.assign(600 * 300, kRed);
  const auto wide = half_blocks(image, {}, {80, 100});
  EXPECT_EQ(wide.size(), 20u);  // 80 by 40 pixels
  EXPECT_EQ(columns(plain(wide.front())), 80u);
  const auto low = half_blocks(image, {}, {200, 10});
  EXPECT_EQ(low.size(), 10u);
  EXPECT_EQ(columns(plain(low.front())), 40u);
  EXPECT_THAT(half_blocks(image, {}, {0, 10}), IsEmpty());
  EXPECT_THAT(half_blocks(Image{}, {}, {80, 24}), IsEmpty());
}

TEST(HalfBlocks, ACellShowsTheMeanLightWithTheGivenDisplay) {
  const Image image{2, 4, {kWhite, kBlack, kBlack, kWhite, kRed, kRed, kRed, kRed}};
  // The mean of two white and two black pixels is half of the light, which is code 188 of sRGB (IEC
  // 61966-2-1). The light 2 is also shown as half of the light if the exposure is -2 stops. NaN is
  // shown as black.
  EXPECT_THAT(half_blocks(image, {}, {1, 1}),
              ElementsAre("\x1b[38;2;188;188;188m\x1b[48;2;255;0;0m▀\x1b[0m"));
  const Image bright{1, 1, {Rgb{2, 2, 2}}};
  EXPECT_THAT(half_blocks(bright, {.exposure = -2}, {1, 1})[0], HasSubstr("188;188;188"));
  const Image broken{1, 1, {Rgb{std::numeric_limits<float>::quiet_NaN(), 0, 0}}};
  EXPECT_THAT(half_blocks(broken, {}, {1, 1})[0], HasSubstr("38;2;0;0;0"));
}

TEST(HalfBlocks, AnUnchangedColourIsWrittenOnce) {
  const Image image{3, 1, {kRed, kRed, kRed}};
  EXPECT_THAT(half_blocks(image, {}, {80, 24}), ElementsAre("\x1b[38;2;255;0;0m▀▀▀\x1b[0m"));
}

}  // namespace
}  // namespace bandsaw::coordinator
