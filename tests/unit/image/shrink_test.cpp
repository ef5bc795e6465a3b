// Reduction of an image by whole factors, one for the width and one for the height. Each pixel of
// the result is the mean of a cell of pixels. At the edges, cells may be smaller.

#include "renderlib/image/shrink.h"

#include <gtest/gtest.h>

namespace bandsaw {
namespace {

/// Returns an image whose red values count the pixels from 0.
Image numbered(std::uint32_t width, std::uint32_t height) {
  Image image{.width = width, .height = height, .pixels = {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    image.pixels.push_back({static_cast<float>(i), 1, 0});
  }
  return image;
}

TEST(Shrink, AFactorOfOneKeepsTheImage) {
  EXPECT_EQ(shrunk(numbered(3, 2), 1, 1).pixels, numbered(3, 2).pixels);
}

TEST(Shrink, PixelsAreMeansOfCellsAlsoAtTheEdges) {
  const Image small = shrunk(numbered(5, 3), 2, 2);
  ASSERT_EQ(small.width, 3u);
  ASSERT_EQ(small.height, 2u);
  EXPECT_EQ(small.at(0, 0), (Rgb{3, 1, 0}));     // mean of 0, 1, 5 and 6
  EXPECT_EQ(small.at(2, 0), (Rgb{6.5f, 1, 0}));  // mean of 4 and 9
  EXPECT_EQ(small.at(2, 1), (Rgb{14, 1, 0}));    // 14 alone
}

TEST(Shrink, MayChangeTheWidthAlone) {
  const Image small = shrunk(numbered(4, 2), 4, 1);
  ASSERT_EQ(small.height, 2u);
  EXPECT_EQ(small.at(0, 1), (Rgb{5.5f, 1, 0}));
}

}  // namespace
}  // namespace bandsaw
