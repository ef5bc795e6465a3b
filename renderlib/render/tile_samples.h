#pragma once

// Tiles, and which samples of theirs are taken in a pass.
//
// A tile is a square of 16 x 16 pixels of the image, counted from its top left; those at the right
// and lower edge may be smaller. Its pixels are two halves, as the squares of a chess board: those
// with x + y even, and the others. A half tile is the unit of adaptive sampling
// (render/adaptive_plan.h): what is decided for one half is read from the other.
//
// The samples of a pass say when it is rendered; which samples of its own sequence a half tile
// takes then is up to the plan: a node (render/band.h) that follows what it has, or none. So what a
// half tile has are always the first samples of its sequence.

#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
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

/// What each half tile of some rows of an image takes: a value, by default the samples of the band.
class TileSamples {
 public:
  TileSamples() = default;
  /// Nothing, of the tiles that the rows meet.
  TileSamples(std::uint32_t width, const RowRange& rows);
  /// What numbers() gave for the same width and rows. INVALID_ARGUMENT: too few or too many of
  /// them, or two that are no node of at most kMaxSamples.
  static absl::StatusOr<TileSamples> from_numbers(absl::Span<const std::uint32_t> numbers,
                                                  std::uint32_t width, const RowRange& rows);

  /// All half tiles take the samples of the band.
  bool whole() const { return taken_.empty(); }
  /// The samples that this pixel takes in a band of these: a node, or empty. y MUST lie in a tile
  /// that the rows meet.
  SampleRange of_pixel(std::uint32_t x, std::uint32_t y, const SampleRange& band) const {
    return whole() ? band : range(taken_[index_of(x, y)]);
  }
  /// Half tile i of those that the rows meet, in the order of TileGrid, takes these: a node of at
  /// most kMaxSamples.
  void set(std::size_t i, const SampleRange& samples) {
    taken_[i] = {static_cast<std::uint32_t>(samples.first),
                 static_cast<std::uint32_t>(samples.last)};
  }

  /// How many samples the pixels of the band take, in an image of this width.
  std::uint64_t count(std::uint32_t width, const Band& band) const;
  /// The same for some of the rows.
  TileSamples of(const RowRange& rows) const;
  /// For a band of some of the rows and a node within the pass: halves of a pass take the halves of
  /// what a half tile takes; a single block goes to the left one.
  TileSamples of(const SampleRange& pass, const Band& band) const;

  /// Two a half tile in the order of TileGrid: its first sample, and how many. Empty: whole.
  std::vector<std::uint32_t> numbers() const;

  friend bool operator==(const TileSamples&, const TileSamples&) = default;

 private:
  /// Half as large as a SampleRange: there is one for every half tile of every pass.
  struct Taken {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    friend bool operator==(const Taken&, const Taken&) = default;
  };
  static SampleRange range(const Taken& taken) { return {taken.first, taken.last}; }
  std::size_t index_of(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{2} *
               (std::size_t{y / kTileSide - first_tile_row_} * columns_ + x / kTileSide) +
           ((x + y) & 1);
  }

  std::uint32_t columns_ = 0;
  std::uint32_t first_tile_row_ = 0;
  std::vector<Taken> taken_;
};

/// INVALID_ARGUMENT: the sums of a pixel that takes no samples are not zero. `tiles`: of the band's
/// rows, or more.
absl::Status check_left_out(const BandPixels& pixels, const TileSamples& tiles);

/// INVALID_ARGUMENT: the counters count samples that the band does not have. `tiles`: likewise.
absl::Status check_counters(const BandPixels& pixels, const TileSamples& tiles);

}  // namespace bandsaw
