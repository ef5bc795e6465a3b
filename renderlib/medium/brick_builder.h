#pragma once

// Makes a VolumeGrid of dense or sparse numbers.

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/types/span.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// Collects bricks: bricks of zeros are left out and equal ones are stored once. The numbers are
/// stored as halves if every one of them is a half.
class BrickBuilder {
 public:
  /// Begins with zeros. `cells` and `channels` MUST be in the ranges of VolumeGrid, and the bricks
  /// at most kMaxGridBricks.
  BrickBuilder(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels);

  /// Sets a brick of the box: the numbers of its cells, x fastest, the channels of a cell together
  /// (kBrickCells * channels of them, each finite and >= 0). Numbers outside of the box become 0.
  void set(std::uint32_t x, std::uint32_t y, std::uint32_t z, absl::Span<const float> numbers);

  /// Returns the grid, with the other members as in a new VolumeGrid. Ends the use of this object.
  VolumeGrid build() &&;

 private:
  std::uint32_t place_of(absl::Span<const float> brick);

  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;
  std::uint32_t channels_;
  std::vector<std::uint32_t> index_;
  std::vector<float> values_;
  std::vector<float> brick_;                                      ///< the one that is being set
  std::unordered_multimap<std::uint64_t, std::uint32_t> places_;  ///< keyed by the brick's hash
  bool halves_ = true;
};

/// Returns the grid of all cells' numbers; the other members as in a new VolumeGrid. `number(i)`
/// returns number i, x fastest, the channels of a cell together; it is called once for each and
/// MUST return a finite number >= 0.
VolumeGrid dense_grid(const std::array<std::uint32_t, 3>& cells, std::uint32_t channels,
                      absl::FunctionRef<float(std::size_t)> number);

}  // namespace bandsaw
