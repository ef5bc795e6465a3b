#pragma once

// Groups of pixels that share their paths (integrate/path_reuse.h), in scenes with path reuse. A
// tile is a square of 16 x 16 pixels, and a half tile is half of the pixels of a tile
// (tile_samples.h).
//
// In a whole tile, the groups are those of the pattern (render/tile_pattern.h). In a tile at the
// edge of the image, the pixels of each half are divided into groups of at most eight, in the order
// of the pattern. A group depends only on the size of the image and on the place of the half tile
// in the image. So bands of any rows have the same groups.

#include <array>
#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/integrate/path_reuse.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// A pixel of the image, counted from the top left of the image.
struct PixelPlace {
  std::uint32_t x = 0;
  std::uint32_t y = 0;
  friend bool operator==(const PixelPlace&, const PixelPlace&) = default;
};

/// The groups of one half tile.
class PixelGroups {
 public:
  /// Makes the groups of half tile number `half_tile` of the grid.
  PixelGroups(const TileGrid& grid, std::size_t half_tile);

  /// Returns the number of groups: 16 in a whole half tile; 0 if it has no pixels.
  std::uint32_t count() const {
    return static_cast<std::uint32_t>((pixels_ + kMaxReusePixels - 1) / kMaxReusePixels);
  }
  /// Returns the pixels of group i. The sizes of a half tile's groups differ by at most one.
  absl::Span<const PixelPlace> group(std::uint32_t i) const {
    const std::uint32_t first = i * pixels_ / count();
    return absl::MakeConstSpan(places_).subspan(first, (i + 1) * pixels_ / count() - first);
  }

 private:
  std::array<PixelPlace, kTileSide * kTileSide / 2> places_;
  std::uint32_t pixels_ = 0;
};

}  // namespace bandsaw
