#pragma once

// Bounds of the values of a grid, brick by brick.

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

/// Bounds of the first channel of a grid, or of all channels if it has three.
class GridBounds {
 public:
  /// `grid` MUST be valid.
  explicit GridBounds(const VolumeGrid& grid);

  /// Returns bounds of the values in the box from `low` to `high` of cell space (low <= high). They
  /// are tight if the box is one brick, or its part inside of the grid's box.
  ValueBounds over(const Vec3& low, const Vec3& high) const;

 private:
  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;
  std::vector<ValueBounds> of_brick_;  ///< includes values interpolated with neighbouring bricks
};

}  // namespace bandsaw
