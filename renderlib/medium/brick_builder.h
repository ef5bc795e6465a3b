#pragma once

// Makes a VolumeGrid (a grid of numbers, stored in bricks of 8 x 8 x 8 cells) from dense or sparse
// numbers. Importers of volumes use it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// Collects bricks. Bricks of zeros are left out, and equal bricks are stored once. The numbers are
/// stored as 16-bit floats (halves) if each of them is exactly a half, otherwise as floats.
class BrickBuilder {
 public:
  /// At first all numbers of the grid are 0. `cells` and `channels` MUST be in the ranges of
  /// VolumeGrid, and there MUST be at most kMaxGridBricks bricks.
  BrickBuilder(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels);

  /// Sets the numbers of the brick whose first cell is (8 x, 8 y, 8 z). `numbers` has kBrickCells *
  /// channels numbers, each finite and >= 0: cell after cell, x fastest, the channels of a cell
  /// together. Numbers of cells outside of the box of `cells` become 0.
  void set(std::uint32_t x, std::uint32_t y, std::uint32_t z, absl::Span<const float> numbers);

  /// Returns the grid: cells, channels, format, index and values are set, the other members are as
  /// in a new VolumeGrid. This object MUST NOT be used afterwards.
  VolumeGrid build() &&;

 private:
  /// Returns the place of a brick in `values_`, counted in bricks. Appends the brick if it is new.
  std::uint32_t place_of(absl::Span<const float> brick);

  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;  ///< number of bricks on each axis
  std::uint32_t channels_;
  std::vector<std::uint32_t> index_;  ///< place_of() each brick; kEmptyBrick if it is all zeros
  std::vector<float> values_;
  std::vector<float> brick_;  ///< the numbers of the brick that set() stores
  /// The place of each stored brick, keyed by the brick's hash.
  std::unordered_multimap<std::uint64_t, std::uint32_t> places_;
  bool halves_ = true;  ///< all numbers up to now are halves
};

/// Returns the grid that BrickBuilder::build() returns for these numbers. `number(i)` returns
/// number i of the box, x fastest, the channels of a cell together. It is called once for each i
/// and MUST return a finite number >= 0.
VolumeGrid dense_grid(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels,
                      absl::FunctionRef<float(std::size_t)> number);

}  // namespace bandsaw
