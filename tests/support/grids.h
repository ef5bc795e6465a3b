#pragma once

// Grids of numbers over space, which define media that vary in space, for tests.

#include <cstdint>
#include <functional>

#include "renderlib/medium/brick_builder.h"
#include "renderlib/medium/volume_grid.h"

namespace bandsaw::test {

/// Returns the grid whose cell (x, y, z) has the number `number(x, y, z)`. The grid fills the box
/// from `low` to `high` in the space of the medium. `cells`: number of cells along x, y and z.
inline VolumeGrid grid_of(
    const std::array<std::uint32_t, 3>& cells, const Vec3& low, const Vec3& high,
    const std::function<float(std::uint32_t, std::uint32_t, std::uint32_t)>& number) {
  VolumeGrid grid = dense_grid(cells, /*channels=*/1, [&](std::size_t i) {
    const auto at = static_cast<std::uint32_t>(i);
    return number(at % cells[0], at / cells[0] % cells[1], at / cells[0] / cells[1]);
  });
  const Vec3 cell{1.0 / cells[0], 1.0 / cells[1], 1.0 / cells[2]};
  grid.to_medium = translation(low) * scaling(high - low) * scaling(cell);
  return grid;
}

}  // namespace bandsaw::test
