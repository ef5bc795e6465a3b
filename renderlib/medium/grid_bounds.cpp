// Computes the bounds of each brick and of its outer layers of cells. The bounds of these layers
// also count for the neighbouring bricks, because values are interpolated across the border.

#include "renderlib/medium/grid_bounds.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>

namespace bandsaw {
namespace {

constexpr ValueBounds kZero{0, 0};
/// Bounds of no value at all.
constexpr ValueBounds kNothing{std::numeric_limits<float>::max(), 0};

/// Returns bounds that contain the values of a and of b.
ValueBounds both(const ValueBounds& a, const ValueBounds& b) {
  return {std::min(a.least, b.least), std::max(a.most, b.most)};
}

/// Part of a brick along one axis: all layers of cells, or only the first or the last.
enum Part : std::uint32_t { kAll, kFirstLayer, kLastLayer };
/// Number of combinations of three such parts, one for each axis.
constexpr std::size_t kParts = 27;

constexpr std::size_t part_number(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return x + 3 * y + 9 * std::size_t{z};
}

using PartBounds = std::array<ValueBounds, kParts>;

/// Returns the bounds of a stored brick for each combination of parts. `inside` is the number of
/// cells of the brick, along each axis, that are in the grid's box.
PartBounds bounds_of_parts(const GridReader& reader, std::uint32_t brick,
                           const std::array<std::uint32_t, 3>& inside) {
  PartBounds parts;
  parts.fill(kNothing);
  // Returns the parts that contain a layer: kAll, and for an outer layer also that layer alone.
  const auto parts_with = [](std::uint32_t layer) {
    const Part own = layer == 0 ? kFirstLayer : layer == kBrickSide - 1 ? kLastLayer : kAll;
    return std::array<Part, 2>{kAll, own};
  };
  for (std::uint32_t z = 0; z < inside[2]; ++z) {
    for (std::uint32_t y = 0; y < inside[1]; ++y) {
      for (std::uint32_t x = 0; x < inside[0]; ++x) {
        ValueBounds cell = kNothing;
        for (std::uint32_t c = 0; c < reader.channels(); ++c) {
          const std::uint32_t number = (z * kBrickSide + y) * kBrickSide + x;
          const float value = reader.stored(brick, number * reader.channels() + c);
          cell = both(cell, {value, value});
        }
        for (const Part in_z : parts_with(z)) {
          for (const Part in_y : parts_with(y)) {
            for (const Part in_x : parts_with(x)) {
              ValueBounds& part = parts[part_number(in_x, in_y, in_z)];
              part = both(part, cell);
            }
          }
        }
      }
    }
  }
  return parts;
}

}  // namespace

GridBounds::GridBounds(const VolumeGrid& grid)
    : cells_(grid.cells), bricks_(brick_counts(grid.cells)), of_brick_(all_bricks(grid.cells)) {
  const GridReader reader(grid);
  const bool linear = grid.filter == VolumeGrid::Filter::kLinear;
  const bool zero_around = linear && grid.border == VolumeGrid::Border::kZero;
  const auto inside = [&](std::size_t axis, std::uint32_t brick) {
    return std::min(kBrickSide, cells_[axis] - brick * kBrickSide);
  };
  const auto place = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return (std::size_t{z} * bricks_[1] + y) * bricks_[0] + x;
  };
  std::fill(of_brick_.begin(), of_brick_.end(), kNothing);
  // Visits every brick and extends the entries of `of_brick_` by the bounds of the brick's values.
  // All values of the brick count for its own entry. If values are interpolated, its outer layers
  // also count for the entries of its neighbours, because the values of a neighbour near the common
  // border depend on these layers.
  PartBounds zeros;
  zeros.fill(kZero);
  for (std::uint32_t z = 0; z < bricks_[2]; ++z) {
    for (std::uint32_t y = 0; y < bricks_[1]; ++y) {
      for (std::uint32_t x = 0; x < bricks_[0]; ++x) {
        const std::uint32_t brick = reader.brick(x, y, z);
        const PartBounds parts =
            brick == kEmptyBrick
                ? zeros
                : bounds_of_parts(reader, brick, {inside(0, x), inside(1, y), inside(2, z)});
        for (std::uint32_t i = 0; i < (linear ? kParts : 1); ++i) {
          // A brick's first layer counts for the brick before it, and its last layer counts for the
          // brick after it.
          const auto neighbour = [](std::uint32_t at, std::uint32_t part) {
            return part == kAll ? at : part == kFirstLayer ? at - 1 : at + 1;
          };
          const std::uint32_t nx = neighbour(x, i % 3);
          const std::uint32_t ny = neighbour(y, i / 3 % 3);
          const std::uint32_t nz = neighbour(z, i / 9);
          if (nx < bricks_[0] && ny < bricks_[1] && nz < bricks_[2]) {
            ValueBounds& to = of_brick_[place(nx, ny, nz)];
            to = both(to, parts[i]);
          }
        }
        const bool at_face = x == 0 || y == 0 || z == 0 || x + 1 == bricks_[0] ||
                             y + 1 == bricks_[1] || z + 1 == bricks_[2];
        if (zero_around && at_face) {
          ValueBounds& own = of_brick_[place(x, y, z)];
          own = both(own, kZero);
        }
      }
    }
  }
}

ValueBounds GridBounds::over(const Vec3& low, const Vec3& high) const {
  const std::array<double, 3> from = {low.x, low.y, low.z};
  const std::array<double, 3> to = {high.x, high.y, high.z};
  std::array<std::uint32_t, 3> first{};
  std::array<std::uint32_t, 3> last{};
  bool leaves = false;
  for (std::size_t k = 0; k < 3; ++k) {
    const double side = cells_[k];
    if (!(to[k] >= 0 && from[k] <= side)) {
      return kZero;
    }
    leaves = leaves || from[k] < 0 || to[k] > side;
    const double begin = std::max(from[k], 0.0) / kBrickSide;
    const double end = std::min(to[k], side) / kBrickSide;
    first[k] = std::min(static_cast<std::uint32_t>(begin), bricks_[k] - 1);
    const double above = std::ceil(end);
    last[k] = std::max(first[k], above < 1 ? 0 : static_cast<std::uint32_t>(above) - 1);
  }
  ValueBounds all = leaves ? kZero : kNothing;
  for (std::uint32_t z = first[2]; z <= last[2]; ++z) {
    for (std::uint32_t y = first[1]; y <= last[1]; ++y) {
      for (std::uint32_t x = first[0]; x <= last[0]; ++x) {
        all = both(all, of_brick_[(std::size_t{z} * bricks_[1] + y) * bricks_[0] + x]);
      }
    }
  }
  return all;
}

}  // namespace bandsaw
