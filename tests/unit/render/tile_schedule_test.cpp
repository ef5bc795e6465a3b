// The order in which half tiles take the samples that the plan of adaptive sampling gives them. A
// half tile is half of the pixels of a tile of 16 x 16 pixels (tile_samples.h). It takes samples in
// whole nodes of the summation tree, which are aligned ranges of 2^k blocks of 8 samples.

#include "renderlib/render/tile_schedule.h"

#include <gtest/gtest.h>

#include <bit>
#include <string>

#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;

constexpr TileGrid kWideGrid{512, 32};  ///< pixels: 32 x 2 tiles

/// Returns a plan that gives the left half of the image twice the uniform number of samples, and
/// the right half an eighth of the uniform number. The level '4' means 2^((6 - 4) / 2) times the
/// uniform number, and 'c' (12) means 2^((6 - 12) / 2) times. `pilot` is the number of samples that
/// all pixels have before the plan is made.
TilePlan half_noisy(std::uint64_t pilot) {
  TilePlan plan{.pilot = pilot, .levels = {}};
  for (std::size_t i = 0; i < kWideGrid.half_tiles(); ++i) {
    plan.levels += i / 2 % kWideGrid.columns() < 16 ? '4' : 'c';
  }
  return plan;
}

/// Returns the samples that half tile i takes; empty if it takes none.
SampleRange of_half_tile(const TileSamples& tiles, std::size_t i) {
  const auto tile = static_cast<std::uint32_t>(i / 2);
  const std::uint32_t y = tile / kWideGrid.columns() * kTileSide;
  const auto half = static_cast<std::uint32_t>(i & 1);
  return tiles.of_pixel(half_row(kWideGrid, tile % kWideGrid.columns(), half, y)[0], y, {});
}

TEST(TileSchedule, HalfTilesTakeTheirShareInConsecutiveNodes) {
  const TilePlan plan = half_noisy(64);
  TileSchedule schedule(kWideGrid, plan);
  std::vector<std::uint64_t> taken(kWideGrid.half_tiles(), 64);
  for (std::uint64_t first = 64; first < 4096; first += 64) {
    const TileSamples tiles = schedule.next({first, first + 64});
    Moments noisy;
    Moments quiet;
    for (std::size_t i = 0; i < taken.size(); ++i) {
      if (const SampleRange more = of_half_tile(tiles, i); more.samples() > 0) {
        ASSERT_TRUE(is_node(more));
        ASSERT_EQ(more.first, taken[i]);
        taken[i] = more.last;
        EXPECT_EQ(taken[i] % (std::bit_floor(taken[i]) / 4), 0u)
            << "the number of samples must be 1, 1.25, 1.5 or 1.75 times a power of two";
      }
      (plan.levels[i] == '4' ? noisy : quiet).add(static_cast<double>(taken[i]));
    }
    const auto due = static_cast<double>(first + 64);
    if (first >= 256) {  // before that, noisy half tiles have less than their share
      EXPECT_NEAR(noisy.mean() / (2 * due), 1, 0.05) << due;
    }
    EXPECT_NEAR(quiet.mean() / std::max(64.0, due / 8), 1, 0.05) << due;
  }
}

// Half tile 0 has 48 samples, fewer than its share. In each pass it takes the longest node that
// begins where its samples end: 16 samples from 48 on, 64 from 64 on, and 128 from 128 on.
TEST(TileSchedule, AHalfTileBelowItsShareTakesTheLongestNode) {
  TileSchedule schedule(kWideGrid, half_noisy(48));
  EXPECT_EQ(of_half_tile(schedule.next({48, 64}), 0), (SampleRange{48, 64}));
  EXPECT_EQ(of_half_tile(schedule.next({64, 128}), 0), (SampleRange{64, 128}));
  EXPECT_EQ(of_half_tile(schedule.next({128, 192}), 0), (SampleRange{128, 256}));
}

// kEvenLevel is the level of a half tile that gets as many samples as with uniform sampling. Here
// the second half tile of each tile has this level.
TEST(TileSchedule, AHalfTileWithTheUniformLevelTakesUniformPasses) {
  TilePlan plan = half_noisy(32);
  for (std::size_t i = 1; i < plan.levels.size(); i += 2) {
    plan.levels[i] = kEvenLevel;
  }
  TileSchedule schedule(kWideGrid, plan);
  for (const SampleRange& pass : {SampleRange{32, 64}, {64, 96}, {96, 100}}) {
    const TileSamples tiles = schedule.next(pass);
    EXPECT_FALSE(tiles.whole());
    for (std::size_t i = 1; i < plan.levels.size(); i += 2) {
      ASSERT_EQ(of_half_tile(tiles, i), pass);
    }
  }
  plan.levels.assign(plan.levels.size(), kEvenLevel);
  EXPECT_TRUE(TileSchedule(kWideGrid, plan).next({32, 64}).whole());
}

}  // namespace
}  // namespace bandsaw
