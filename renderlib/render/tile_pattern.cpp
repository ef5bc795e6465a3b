// The pattern gives each pixel of a tile (16 x 16 pixels) the number of a group. The pixels of a
// group may share paths. A hash of the tile's position decides whether the tile uses the pattern
// mirrored horizontally, vertically, both or not at all.

#include "renderlib/render/tile_pattern.h"

#include <array>

#include "renderlib/base/split_mix.h"

namespace bandsaw {
namespace {

using Row = std::array<std::uint8_t, kTileSide>;
constexpr std::array<Row, kTileSide> kPattern = {{
    {{7, 13, 13, 31, 20, 22, 31, 4, 3, 0, 10, 13, 0, 3, 22, 22}},
    {{4, 31, 10, 13, 22, 7, 7, 3, 22, 13, 22, 10, 21, 4, 10, 3}},
    {{20, 20, 8, 3, 10, 29, 21, 13, 4, 20, 4, 21, 29, 0, 21, 21}},
    {{31, 8, 23, 4, 23, 8, 0, 3, 31, 22, 7, 29, 22, 3, 24, 0}},
    {{7, 31, 13, 4, 29, 21, 20, 13, 24, 10, 4, 3, 10, 29, 18, 0}},
    {{20, 31, 7, 7, 20, 23, 31, 10, 18, 8, 23, 21, 0, 24, 21, 24}},
    {{8, 23, 25, 20, 29, 17, 8, 7, 24, 29, 15, 26, 18, 0, 24, 29}},
    {{25, 17, 8, 28, 15, 18, 25, 15, 25, 28, 16, 26, 16, 18, 15, 15}},
    {{28, 23, 8, 25, 23, 17, 26, 6, 23, 15, 24, 17, 17, 18, 26, 18}},
    {{11, 27, 28, 25, 15, 11, 1, 11, 18, 28, 6, 6, 19, 30, 24, 26}},
    {{17, 6, 12, 25, 1, 17, 12, 19, 28, 27, 25, 12, 26, 15, 16, 16}},
    {{28, 1, 11, 27, 5, 14, 28, 6, 9, 17, 16, 30, 9, 2, 16, 19}},
    {{1, 11, 14, 6, 5, 14, 19, 16, 30, 2, 26, 1, 9, 5, 19, 26}},
    {{12, 27, 12, 9, 27, 19, 11, 12, 2, 1, 11, 14, 5, 6, 30, 2}},
    {{11, 14, 1, 2, 30, 2, 1, 27, 9, 6, 12, 19, 19, 16, 30, 9}},
    {{27, 5, 5, 14, 14, 5, 12, 9, 14, 27, 30, 5, 30, 2, 9, 2}},
}};

}  // namespace

std::uint32_t group_in_tile(std::uint32_t x, std::uint32_t y) {
  const std::uint64_t tile = std::uint64_t{y / kTileSide} << 32 | x / kTileSide;
  const std::uint64_t mirror = split_mix(tile * kSplitMixIncrement + 1);
  const std::uint32_t column = x % kTileSide ^ ((mirror & 1) != 0 ? kTileSide - 1 : 0);
  const std::uint32_t row = y % kTileSide ^ ((mirror & 2) != 0 ? kTileSide - 1 : 0);
  return kPattern[row][column];
}

}  // namespace bandsaw
