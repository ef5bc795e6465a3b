#pragma once

// Bounds of the values of a grid, brick by brick (a brick is 8 x 8 x 8 cells, volume_grid.h).
// grid_medium.h computes the bounds of a medium's density from them. Tracking (tracking.h) needs
// the bounds of the density.

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

  /// Returns bounds of the values in the box from `low` to `high` of cell space (low <= high). They
  /// are the bounds of all bricks that the box touches, and include 0 if the box leaves the grid's
  /// box. They are as tight as possible if the box is exactly one brick, or exactly the part of a
  /// brick that is in the grid's box.
  ValueBounds over(const Vec3& low, const Vec3& high) const;

 private:
  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;
  /// The bounds of each brick, x fastest. They include the values that are interpolated between the
  /// brick and its neighbours.
  std::vector<ValueBounds> of_brick_;
};

}  // namespace bandsaw
