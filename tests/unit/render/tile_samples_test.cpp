// The samples that each half tile takes in one pass of an adaptive image. A half tile is half of
// the pixels of a tile of 16 x 16 pixels. A pass gives it one node or no samples. A node is an
// aligned range of 2^k blocks of 8 samples.

#include "renderlib/render/tile_samples.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace bandsaw {
namespace {

using ::testing::HasSubstr;

constexpr SampleRange kPass{256, 384};

/// Returns a random node of up to 32 blocks; in a third of the cases an empty range.
SampleRange random_node(test::Random& random) {
  const std::uint64_t size = kBlockSamples << random.below(6);
  const std::uint64_t first = random.below(9) * size;
  return random.below(3) == 0 ? SampleRange{} : SampleRange{first, first + size};
}

/// A random range of samples for each half tile of an image. `of_pixel`: the samples that each
/// pixel takes, row by row.
struct RandomTiles {
  TileSamples tiles;
  std::vector<SampleRange> of_pixel;
};

RandomTiles random_tiles(std::uint32_t width, std::uint32_t height) {
  test::Random random(width * 1000 + height);
  const TileGrid grid{width, height};
  std::vector<SampleRange> halves(grid.half_tiles());
  RandomTiles out{TileSamples(width, {0, height}), {}};
  for (std::uint32_t y = 0; y < height; y += kTileSide) {
    for (std::uint32_t x = 0; x < width; x += kTileSide) {
      for (const std::uint32_t half : {0, 1}) {
        const std::size_t i = 2 * (y / kTileSide * grid.columns() + x / kTileSide) + half;
        halves[i] = random_node(random);
        out.tiles.set(i, halves[i]);
      }
    }
  }
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      out.of_pixel.push_back(
          halves[2 * (y / kTileSide * grid.columns() + x / kTileSide) + half_of(x, y)]);
    }
  }
  return out;
}

TEST(TileSamples, DescribeHalfTilesOfAnyImageAndRows) {
  for (const std::uint32_t width : {1, 15, 16, 17, 70}) {
    for (const std::uint32_t height : {1, 16, 33, 50}) {
      const RandomTiles given = random_tiles(width, height);
      for (const RowRange& rows :
           {RowRange{0, height}, {height / 2, height}, {0, height / 3 + 1}}) {
        const TileSamples part = given.tiles.of(rows);
        std::uint64_t samples = 0;
        for (std::uint32_t y = rows.first; y < rows.last; ++y) {
          for (std::uint32_t x = 0; x < width; ++x) {
            const SampleRange& expected = given.of_pixel[y * width + x];
            ASSERT_EQ(part.of_pixel(x, y, kPass), expected) << x << " " << y;
            samples += expected.samples();
          }
        }
        EXPECT_EQ(part.count(width, {kPass, rows}), samples);
        EXPECT_EQ(given.tiles.count(width, {kPass, rows}), samples);
        EXPECT_EQ(given.tiles.of(kPass, {kPass, rows}), part);
        const auto again = TileSamples::from_numbers(part.numbers(), width, rows);
        ASSERT_TRUE(again.ok()) << again.status();
        EXPECT_EQ(*again, part);
      }
    }
  }
}

TEST(TileSamples, DefaultToTheSamplesOfTheBand) {
  const TileSamples all;
  EXPECT_TRUE(all.whole());
  EXPECT_EQ(all.of_pixel(100, 7, kPass), kPass);
  EXPECT_TRUE(all.of({3, 9}).whole());
  EXPECT_TRUE(all.of(kPass, {{256, 320}, {3, 9}}).whole());
  EXPECT_EQ(all.count(10, {{0, 12}, {2, 5}}), 30u * 12);
  EXPECT_TRUE(TileSamples::from_numbers({}, 10, {2, 5})->whole());
}

// In an adaptive pass, a half tile takes a node of samples that differs from that of the pass. If
// the pass is split into bands, the node is split in proportion. The bands together take each
// sample of the half tile exactly once, and each band takes one node or none.
TEST(TileSamples, PartsOfAPassAddUpToThePass) {
  test::Random random(7);
  const RowRange row{0, 1};
  for (int i = 0; i < 200; ++i) {
    TileSamples tiles(1, row);
    const SampleRange taken = random_node(random);
    tiles.set(0, taken);
    std::vector<SampleRange> parts{kPass};
    for (int cuts = 0; cuts < 5; ++cuts) {
      const auto at = parts.begin() + random.below(static_cast<std::uint32_t>(parts.size()));
      if (at->blocks() > 1) {
        const Halves halves = split(*at);
        *at = halves.right;
        parts.insert(at, halves.left);
      }
    }
    std::uint64_t end = taken.first;
    for (const SampleRange& part : parts) {
      const TileSamples of_part = tiles.of(kPass, {part, row});
      const SampleRange within = of_part.of_pixel(0, 0, part);
      if (within.samples() > 0) {
        EXPECT_TRUE(is_node(within));
        EXPECT_EQ(within.first, end);
        end = within.last;
      }
      if (part.blocks() > 1) {
        const Band half{split(part).right, row};
        EXPECT_EQ(of_part.of(part, half), tiles.of(kPass, half));
      }
    }
    EXPECT_EQ(end, taken.last);
  }
}

// There are two numbers for each half tile: its first sample and its number of samples.
TEST(TileSamples, InvalidNumbersAreRefused) {
  const auto refused = [](const std::vector<std::uint32_t>& numbers, const RowRange& rows) {
    const auto tiles = TileSamples::from_numbers(numbers, 16, rows);
    EXPECT_EQ(tiles.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(tiles.status().message());
  };
  EXPECT_THAT(refused({0, 16, 0}, {8, 24}),
              HasSubstr("rows [8, 24) of width 16 need 8 numbers or none, are 3"));
  EXPECT_THAT(refused({0, 16, 16, 32}, {0, 1}),
              HasSubstr("half tile 1 takes samples [16, 48); must be empty, or an aligned range"));
  EXPECT_THAT(refused({1u << 30, 16, 0, 0}, {0, 1}), HasSubstr("below 1073741824"));
  EXPECT_THAT(refused({0, 0, 0xffffffff, 0xffffffff}, {0, 1}), HasSubstr("half tile 1"));
}

TEST(TileSamples, SumsOfPixelsWithoutSamplesMustBeZero) {
  const RandomTiles given = random_tiles(20, 20);
  BandPixels pixels{.band = {{0, 16}, {3, 20}}, .width = 20, .sums = {}, .counters = {}};
  for (std::uint32_t y = 3; y < 20; ++y) {
    for (std::uint32_t x = 0; x < 20; ++x) {
      pixels.sums.insert(pixels.sums.end(), 3,
                         given.of_pixel[y * 20 + x].samples() > 0 ? 1.5 : 0.0);
    }
  }
  EXPECT_TRUE(check_left_out(pixels, given.tiles).ok());
  EXPECT_TRUE(check_left_out(pixels, {}).ok());
  const auto left_out = std::find(pixels.sums.begin(), pixels.sums.end(), 0.0);
  ASSERT_NE(left_out, pixels.sums.end());
  *left_out = 1e-300;
  EXPECT_THAT(std::string(check_left_out(pixels, given.tiles).message()),
              HasSubstr("its half tile takes none"));
}

TEST(TileSamples, CountersMustFitTheSamplesTaken) {
  TileSamples tiles(16, {0, 4});
  tiles.set(0, {64, 128});
  BandPixels pixels{.band = {{64, 80}, {0, 4}}, .width = 16, .sums = {}, .counters = {}};
  const auto good = [&](const Counters& counters) {
    pixels.counters = counters;
    return check_counters(pixels, tiles).ok();
  };
  EXPECT_TRUE(good({.bad_samples = 1, .bad_x = 2, .bad_y = 2, .bad_sample = 100}));
  EXPECT_FALSE(good({.bad_samples = 1, .bad_x = 2, .bad_y = 2, .bad_sample = 128}));
  EXPECT_FALSE(good({.bad_samples = 1, .bad_x = 3, .bad_y = 2, .bad_sample = 70}))
      << "the pixel is in the other half, which takes no samples";
  EXPECT_FALSE(good({.bad_samples = 1, .bad_x = 16, .bad_y = 2, .bad_sample = 100}));
  EXPECT_FALSE(good({.bad_samples = 1, .bad_x = 2, .bad_y = 4, .bad_sample = 100}));
  // Half tile 0 has 32 pixels in the four rows, and each pixel takes 64 samples.
  EXPECT_TRUE(good({.truncated_paths = 32 * 64}));
  EXPECT_FALSE(good({.truncated_paths = 32 * 64 + 1}));
}

}  // namespace
}  // namespace bandsaw
