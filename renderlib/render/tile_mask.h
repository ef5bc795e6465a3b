#pragma once

// Tiles, and which of them take part in a pass.
//
// A tile is a square of 16 x 16 pixels of the image, counted from its top left; those at the right
// and lower edge may be smaller. Its pixels are two halves, as the squares of a chess board: those
// with x + y even, and the others. A half tile is the unit of adaptive sampling
// (render/adaptive_plan.h): what is decided for one half is read from the other.

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "renderlib/render/band.h"

namespace bandsaw {

inline constexpr std::uint32_t kTileSide = 16;  ///< pixels

/// The half tiles of an image, numbered row by row, the even half of a tile first.
struct TileGrid {
  std::uint32_t width = 0;   ///< pixels, > 0
  std::uint32_t height = 0;  ///< pixels, > 0

  std::uint32_t columns() const { return (width + kTileSide - 1) / kTileSide; }
  std::uint32_t rows() const { return (height + kTileSide - 1) / kTileSide; }
  std::size_t half_tiles() const { return std::size_t{2} * columns() * rows(); }
  friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

/// The pixels of one row of a half tile: first, first + 2, … below last. May be empty at the edge.
struct HalfRow {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
  std::uint32_t count() const { return first < last ? (last - first + 1) / 2 : 0; }
};
/// `half`: 0 or 1.
HalfRow half_row(const TileGrid& grid, std::uint32_t column, std::uint32_t half, std::uint32_t y);

/// Which pixels of some rows of an image take part: a value, by default all of all rows.
class TileMask {
 public:
  TileMask() = default;
  /// None of the tiles that the rows meet.
  TileMask(std::uint32_t width, const RowRange& rows);
  /// What bits() gave for the same width and rows. INVALID_ARGUMENT: too few or too many of them.
  static absl::StatusOr<TileMask> from_bits(std::string bits, std::uint32_t width,
                                            const RowRange& rows);

  /// All pixels take part.
  bool whole() const { return bits_.empty(); }
  /// y MUST lie in a tile that the mask's rows meet.
  bool has(std::uint32_t x, std::uint32_t y) const {
    return whole() || (bits_[bit_of(x, y) / 8] >> (bit_of(x, y) % 8) & 1) != 0;
  }
  /// The half tile of this pixel takes part.
  void add(std::uint32_t x, std::uint32_t y);

  /// How many pixels of these rows of an image of this width take part.
  std::uint64_t pixels(std::uint32_t width, const RowRange& rows) const;
  /// What it says of some of its rows.
  TileMask of(const RowRange& rows) const;

  /// One bit a half tile in the order of TileGrid, a byte's lowest first; empty: whole.
  const std::string& bits() const { return bits_; }

  friend bool operator==(const TileMask&, const TileMask&) = default;

 private:
  std::size_t bit_of(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{2} *
               (std::size_t{y / kTileSide - first_tile_row_} * columns_ + x / kTileSide) +
           ((x + y) & 1);
  }

  std::uint32_t columns_ = 0;
  std::uint32_t first_tile_row_ = 0;
  std::string bits_;
};

/// INVALID_ARGUMENT: the sums of a pixel that does not take part are not zero. The mask is of the
/// band's rows, or more.
absl::Status check_left_out(const BandPixels& pixels, const TileMask& mask);

}  // namespace bandsaw
