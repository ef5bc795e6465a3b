// Groups of pixels that share paths. They partition every half tile, which is half of the pixels of
// a tile of 16 x 16. Neighbouring pixels are rarely in one group.

#include "renderlib/render/pixel_groups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <vector>

namespace bandsaw::test {
namespace {

/// Returns for each pixel the number of its group, or -1 if the pixel is in no group. The groups
/// are numbered over the whole image. Checks that each group is in one half tile, that no pixel is
/// in two groups, and that the groups of a half tile differ by at most one pixel in size.
std::vector<int> groups_of(const TileGrid& grid) {
  std::vector<int> groups(std::size_t{grid.width} * grid.height, -1);
  int number = 0;
  for (std::size_t half_tile = 0; half_tile < grid.half_tiles(); ++half_tile) {
    const PixelGroups of_half_tile(grid, half_tile);
    std::size_t smallest = kMaxReusePixels;
    std::size_t largest = 0;
    for (std::uint32_t i = 0; i < of_half_tile.count(); ++i, ++number) {
      const auto group = of_half_tile.group(i);
      smallest = std::min(smallest, group.size());
      largest = std::max(largest, group.size());
      for (const auto& [x, y] : group) {
        EXPECT_EQ(2 * (y / kTileSide * grid.columns() + x / kTileSide) + half_of(x, y), half_tile);
        int& at = groups[std::size_t{y} * grid.width + x];
        EXPECT_EQ(at, -1);
        at = number;
      }
    }
    if (of_half_tile.count() > 0) {
      EXPECT_GE(smallest, 1u);
      EXPECT_LE(largest - smallest, 1u);
    }
  }
  return groups;
}

TEST(PixelGroups, PartitionTheImage) {
  for (const TileGrid& grid :
       {TileGrid{1, 1}, TileGrid{16, 16}, TileGrid{21, 11}, TileGrid{40, 33}, TileGrid{3, 100}}) {
    const std::vector<int> groups = groups_of(grid);
    EXPECT_EQ(std::count(groups.begin(), groups.end(), -1), 0) << grid.width << " " << grid.height;
  }
}

TEST(PixelGroups, AWholeHalfTileHasSixteenGroupsOfEightPixels) {
  const PixelGroups groups({64, 48}, 9);
  EXPECT_EQ(groups.count(), 16u);
  for (std::uint32_t i = 0; i < groups.count(); ++i) {
    EXPECT_EQ(groups.group(i).size(), kMaxReusePixels);
  }
}

TEST(PixelGroups, HalvesHaveEightPixelsInEachRowOfATile) {
  const TileGrid grid{48, 40};
  for (std::uint32_t y = 0; y < 40; ++y) {
    for (std::uint32_t column = 0; column < 3; ++column) {
      for (const std::uint32_t half : {0u, 1u}) {
        const HalfRow row = half_row(grid, column, half, y);
        EXPECT_EQ(row.count(), 8u);
        for (const std::uint32_t x : row) {
          EXPECT_EQ(half_of(x, y), half);
          EXPECT_EQ(x / kTileSide, column);
        }
      }
    }
  }
}

// At most 5.1 % of all pairs of pixels with the same offset are in one group. The tested bound of
// 5.25 % allows for the edge of the image. The errors of two pixels in one group have a correlation
// of up to 0.95, so the correlation at any offset is at most 5 % on average.
TEST(PixelGroups, PixelsAtEveryDistanceRarelyShareAGroup) {
  constexpr int kSide = 256;
  const std::vector<int> groups = groups_of({kSide, kSide});
  for (int dy = 0; dy <= 16; ++dy) {
    for (int dx = -16; dx <= 16; ++dx) {
      if (dy == 0 && dx <= 0) {
        continue;
      }
      double pairs = 0;
      double shared = 0;
      for (int y = 0; y + dy < kSide; ++y) {
        for (int x = std::max(0, -dx); x + std::max(0, dx) < kSide; ++x) {
          pairs += 1;
          shared += groups[static_cast<std::size_t>(y * kSide + x)] ==
                            groups[static_cast<std::size_t>((y + dy) * kSide + x + dx)]
                        ? 1
                        : 0;
        }
      }
      EXPECT_LE(shared / pairs, 0.0525) << dx << ", " << dy;
    }
  }
}

}  // namespace
}  // namespace bandsaw::test
