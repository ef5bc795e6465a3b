#pragma once

// Bounds of the values of a grid, brick by brick (a brick is 8 x 8 x 8 cells, volume_grid.h).
// Tracking needs them (grid_medium.h).

#include <cstdint>
#include <vector>

#include "renderlib/math/vec.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw {

/// The least and the largest value at any point of a region.
struct ValueBounds {
  float least = 0;
  float most = 0;
};

/// Bounds of the values of a grid; if it has three channels, each bound holds for all of them.
class GridBounds {
 public:
  /// `grid` MUST be valid.
  explicit GridBounds(const VolumeGrid& grid);

  /// Returns bounds of the values in the box from `low` to `high` of cell space (low <= high):
  /// those of all bricks that the box touches. They are as tight as possible if the box is exactly
  /// one brick, or exactly the part of a brick that is in the grid's box.
  ValueBounds over(const Vec3& low, const Vec3& high) const;

 private:
  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;
  std::vector<ValueBounds> of_brick_;  ///< includes values interpolated with neighbouring bricks
};

}  // namespace bandsaw
