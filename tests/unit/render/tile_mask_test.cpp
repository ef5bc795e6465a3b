#include "renderlib/render/tile_mask.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

/// Some half tiles of an image, and the same pixel by pixel.
struct Some {
  TileMask mask;
  std::vector<bool> has;
};

Some some(std::uint32_t width, std::uint32_t height) {
  test::Random random(width * 1000 + height);
  const TileGrid grid{width, height};
  std::vector<bool> halves(grid.half_tiles());
  Some out{TileMask(width, {0, height}), {}};
  for (std::uint32_t y = 0; y < height; y += kTileSide) {
    for (std::uint32_t x = 0; x < width; x += kTileSide) {
      for (const std::uint32_t half : {0, 1}) {
        const std::size_t i = 2 * (y / kTileSide * grid.columns() + x / kTileSide) + half;
        halves[i] = random.below(2) == 0;
        if (halves[i]) {
          out.mask.add(x + half, y);
        }
      }
    }
  }
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      out.has.push_back(
          halves[2 * (y / kTileSide * grid.columns() + x / kTileSide) + ((x + y) & 1)]);
    }
  }
  return out;
}

TEST(TileMask, HoldsHalfTilesOfAnyImageAndAnyOfItsRows) {
  for (const std::uint32_t width : {1, 15, 16, 17, 70}) {
    for (const std::uint32_t height : {1, 16, 33, 50}) {
      const Some given = some(width, height);
      for (const RowRange& rows :
           {RowRange{0, height}, {height / 2, height}, {0, height / 3 + 1}}) {
        const TileMask part = given.mask.of(rows);
        std::uint64_t pixels = 0;
        for (std::uint32_t y = rows.first; y < rows.last; ++y) {
          for (std::uint32_t x = 0; x < width; ++x) {
            ASSERT_EQ(part.has(x, y), given.has[y * width + x]) << x << " " << y;
            pixels += given.has[y * width + x] ? 1 : 0;
          }
        }
        EXPECT_EQ(part.pixels(width, rows), pixels);
        EXPECT_EQ(given.mask.pixels(width, rows), pixels);
        const auto again = TileMask::from_bits(part.bits(), width, rows);
        ASSERT_TRUE(again.ok()) << again.status();
        EXPECT_EQ(*again, part);
      }
    }
  }
}

TEST(TileMask, ByDefaultAllTakePart) {
  const TileMask all;
  EXPECT_TRUE(all.whole());
  EXPECT_TRUE(all.has(100, 7));
  EXPECT_TRUE(all.of({3, 9}).whole());
  EXPECT_EQ(all.pixels(10, {2, 5}), 30u);
  EXPECT_TRUE(TileMask::from_bits("", 10, {2, 5})->whole());
}

TEST(TileMask, BitsOfAnotherSizeAreRefused) {
  const auto mask = TileMask::from_bits(std::string(3, '\0'), 64, {8, 24});
  EXPECT_EQ(mask.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(mask.status().message()),
              HasSubstr("rows [8, 24) of width 64 need 2 bytes or none, are 3"));
}

TEST(TileMask, SumsOfWhatIsLeftOutMustBeZero) {
  const Some given = some(20, 20);
  BandPixels pixels{.band = {{0, 16}, {3, 20}}, .width = 20, .sums = {}, .counters = {}};
  for (std::uint32_t y = 3; y < 20; ++y) {
    for (std::uint32_t x = 0; x < 20; ++x) {
      pixels.sums.insert(pixels.sums.end(), 3, given.has[y * 20 + x] ? 1.5 : 0.0);
    }
  }
  EXPECT_TRUE(check_left_out(pixels, given.mask).ok());
  EXPECT_TRUE(check_left_out(pixels, {}).ok());
  const auto left_out = std::find(pixels.sums.begin(), pixels.sums.end(), 0.0);
  ASSERT_NE(left_out, pixels.sums.end());
  *left_out = 1e-300;
  EXPECT_THAT(std::string(check_left_out(pixels, given.mask).message()),
              HasSubstr("does not take part"));
}

}  // namespace
}  // namespace bandsaw
