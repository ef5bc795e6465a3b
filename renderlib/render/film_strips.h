#pragma once

// Strips of a film: pixels of one row that always have the same samples.

#include <cstdint>

#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// The pixels first, first + step, …
struct Strip {
  std::uint32_t first = 0;
  std::uint32_t step = 1;
  std::uint32_t count = 0;  ///< may be 0
};

/// Strips are whole rows, or each row's part of each half tile, in order.
class FilmStrips {
 public:
  FilmStrips(const TileGrid& grid, bool half_tiles) : grid_(grid), half_tiles_(half_tiles) {}

  std::uint32_t per_row() const { return half_tiles_ ? 2 * grid_.columns() : 1; }
  /// Returns the maximum number of pixels in a strip.
  std::uint32_t longest() const { return half_tiles_ ? kTileSide / 2 : grid_.width; }
  Strip strip(std::uint32_t y, std::uint32_t index) const {
    if (!half_tiles_) {
      return {0, 1, grid_.width};
    }
    const HalfRow row = half_row(grid_, index / 2, index % 2, y);
    return {row.first, 2, row.count()};
  }
  /// Returns the half tile that contains strip `index` of row y, in the order of TileGrid.
  std::size_t half_tile(std::uint32_t y, std::uint32_t index) const {
    return std::size_t{y / kTileSide} * per_row() + index;
  }
  bool half_tiles() const { return half_tiles_; }
  const TileGrid& grid() const { return grid_; }

 private:
  TileGrid grid_;
  bool half_tiles_;
};

}  // namespace bandsaw
