#pragma once

// Tiles of an image, and the samples that they take in a pass. A pass is one range of samples,
// rendered for the whole image.
//
// The image is divided into tiles of 16 x 16 pixels from its top left; tiles at the right and lower
// edge may be smaller. The pixels of a tile form 32 groups of eight (render/tile_pattern.h). The
// even groups are one half tile, and the odd groups are the other one. Each half tile has eight
// pixels in every row of a whole tile. A half tile is the unit of adaptive sampling
// (render/adaptive_plan.h). The errors of one half of the image decide how many samples the half
// tiles of the other half take.
//
// Each half tile has its own sequence of samples. In each pass, the half tile takes the next node
// of this sequence, or none, as the plan says. A node is an aligned range of 2^k blocks of 8
// samples (render/band.h). So the half tile always has the first samples of its sequence, and the
// pass determines only when the half tile takes them.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "absl/types/span.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_pattern.h"

namespace bandsaw {

/// The half tiles of an image, numbered row by row, the even half of each tile first.
struct TileGrid {
  std::uint32_t width = 0;   ///< pixels, > 0
  std::uint32_t height = 0;  ///< pixels, > 0

  std::uint32_t columns() const { return (width + kTileSide - 1) / kTileSide; }
  std::uint32_t rows() const { return (height + kTileSide - 1) / kTileSide; }
  std::size_t half_tiles() const { return std::size_t{2} * columns() * rows(); }
  friend bool operator==(const TileGrid&, const TileGrid&) = default;
};

/// Returns the half of its tile to which a pixel belongs: 0 is the even half, 1 the odd half.
inline std::uint32_t half_of(std::uint32_t x, std::uint32_t y) { return group_in_tile(x, y) & 1; }

/// The pixels of one row of a half tile, from left to right. May be empty at the edge.
class HalfRow {
 public:
  void add(std::uint32_t x) { xs_[count_++] = x; }
  std::uint32_t count() const { return count_; }
  std::uint32_t operator[](std::size_t i) const { return xs_[i]; }
  const std::uint32_t* begin() const { return xs_.data(); }
  const std::uint32_t* end() const { return xs_.data() + count_; }

 private:
  std::array<std::uint32_t, kTileSide / 2> xs_ = {};
  std::uint32_t count_ = 0;
};
/// Returns the part of row y of the image in half 0 or 1 of the tile in this column of tiles.
HalfRow half_row(const TileGrid& grid, std::uint32_t column, std::uint32_t half, std::uint32_t y);

/// The samples that each half tile of some rows of an image takes. A value type; by default all
/// half tiles take the samples of the band.
class TileSamples {
 public:
  TileSamples() = default;
  /// Makes an entry for each half tile of the tiles that the rows overlap. At first, no half tile
  /// takes samples.
  TileSamples(std::uint32_t width, const RowRange& rows);
  /// Restores the result of numbers() for the same width and rows. Returns INVALID_ARGUMENT if the
  /// count of the numbers is wrong, or if a half tile has samples that are no node or end after
  /// kMaxSamples.
  static absl::StatusOr<TileSamples> from_numbers(absl::Span<const std::uint32_t> numbers,
                                                  std::uint32_t width, const RowRange& rows);

  /// Returns true if all half tiles take the samples of the band.
  bool whole() const { return taken_.empty(); }
  /// Returns the samples that this pixel takes in a band with samples `band`: a node, or empty. y
  /// MUST lie in a tile that the rows overlap.
  SampleRange of_pixel(std::uint32_t x, std::uint32_t y, const SampleRange& band) const {
    return whole() ? band : range(taken_[index_of(x, y)]);
  }
  /// Sets the samples of half tile i, counted in the order of TileGrid from the first tile that the
  /// rows overlap. `samples` is empty, or a node that ends at or before kMaxSamples.
  void set(std::size_t i, const SampleRange& samples) {
    taken_[i] = {static_cast<std::uint32_t>(samples.first),
                 static_cast<std::uint32_t>(samples.last)};
  }

  /// Returns the number of samples of all pixels in the band, in an image of this width.
  std::uint64_t count(std::uint32_t width, const Band& band) const;
  /// Returns the same samples for `rows` alone, which are some of the rows of this object.
  TileSamples of(const RowRange& rows) const;
  /// Returns the part for a band. The band has some of the rows, and its samples are a node within
  /// `pass`, for which this object was made. The band takes the corresponding part of each half
  /// tile's samples. For example, a band with the first half of the pass takes the first half of
  /// the half tile's samples, or all of them if they are a single block.
  TileSamples of(const SampleRange& pass, const Band& band) const;

  /// Returns two numbers for each half tile in the order of TileGrid: its first sample and its
  /// sample count. Empty if whole().
  std::vector<std::uint32_t> numbers() const;

  friend bool operator==(const TileSamples&, const TileSamples&) = default;

 private:
  /// The samples [first, last) of one half tile. This struct has half the size of a SampleRange,
  /// because a pass has many half tiles.
  struct Taken {
    std::uint32_t first = 0;
    std::uint32_t last = 0;
    friend bool operator==(const Taken&, const Taken&) = default;
  };
  static SampleRange range(const Taken& taken) { return {taken.first, taken.last}; }
  std::size_t index_of(std::uint32_t x, std::uint32_t y) const {
    return std::size_t{2} *
               (std::size_t{y / kTileSide - first_tile_row_} * columns_ + x / kTileSide) +
           half_of(x, y);
  }

  std::uint32_t columns_ = 0;
  std::uint32_t first_tile_row_ = 0;
  std::vector<Taken> taken_;
};

// The coordinator checks the bands that workers send with the following functions.

/// Returns INVALID_ARGUMENT if the sums of a pixel without samples are not zero. `tiles` covers at
/// least the band's rows.
absl::Status check_left_out(const BandPixels& pixels, const TileSamples& tiles);

/// Returns INVALID_ARGUMENT if the counters exceed the samples of the band or locate a bad sample
/// outside it. `tiles` covers at least the band's rows.
absl::Status check_counters(const BandPixels& pixels, const TileSamples& tiles);

}  // namespace bandsaw
