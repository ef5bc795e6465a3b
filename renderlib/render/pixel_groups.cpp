// A group is up to eight pixels that may share paths. group_in_tile() gives each pixel of a tile
// the number of its group. Even numbers form one half tile, and odd numbers form the other half
// tile. The constructor collects the pixels of a half tile and sorts them by the numbers of their
// groups.

#include "renderlib/render/pixel_groups.h"

#include <algorithm>

namespace bandsaw {

PixelGroups::PixelGroups(const TileGrid& grid, std::size_t half_tile) {
  const std::size_t tile = half_tile / 2;
  const auto left = static_cast<std::uint32_t>(tile % grid.columns()) * kTileSide;
  const auto top = static_cast<std::uint32_t>(tile / grid.columns()) * kTileSide;
  for (std::uint32_t y = top; y < std::min(top + kTileSide, grid.height); ++y) {
    for (std::uint32_t x = left; x < std::min(left + kTileSide, grid.width); ++x) {
      if (half_of(x, y) == half_tile % 2) {
        places_[pixels_++] = {x, y};
      }
    }
  }
  std::stable_sort(places_.begin(), places_.begin() + pixels_,
                   [](const PixelPlace& a, const PixelPlace& b) {
                     return group_in_tile(a.x, a.y) < group_in_tile(b.x, b.y);
                   });
}

}  // namespace bandsaw
