#pragma once

// A grid of numbers over a box in space, by which a medium varies (medium.h). It is stored
// sparsely, in bricks of 8 x 8 x 8 cells: bricks that are all 0 are left out, and equal bricks are
// stored once. (Bricks are like the leaves of OpenVDB: Museth 2013, "VDB: High-Resolution Sparse
// Volumes with Dynamic Topology".)
//
// Cell space: cell (i, j, k) is the unit cube from (i, j, k) to (i + 1, j + 1, k + 1), and its
// number is the value at its centre.

#include <array>
#include <cstddef>
#include <cstdint>

#include "absl/status/statusor.h"
#include "renderlib/base/shared_bytes.h"
#include "renderlib/math/rgb.h"
#include "renderlib/math/transform.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

inline constexpr std::uint32_t kBrickSide = 8;  ///< cells
inline constexpr std::uint32_t kBrickCells = kBrickSide * kBrickSide * kBrickSide;
/// Entry of the index for a brick whose numbers are all 0.
inline constexpr std::uint32_t kEmptyBrick = 0xffffffffu;
inline constexpr std::uint32_t kMaxGridSide = 1u << 20;                  ///< cells
inline constexpr std::uint64_t kMaxGridBricks = std::uint64_t{1} << 26;  ///< entries of the index

/// Numbers of a grid, each >= 0 and finite.
struct VolumeGrid {
  enum class Format { kFloat32, kFloat16 };  ///< IEEE 754, little-endian
  enum class Filter { kLinear, kNearest };   ///< between cell centres, or constant in each cell
  /// How values are interpolated between the outermost cell centres and the faces of the box. The
  /// cells beyond the faces have the number 0 (kZero) or the numbers of the outermost cells
  /// (kClamp). Outside of the box the value is always 0.
  enum class Border { kZero, kClamp };

  std::array<std::uint32_t, 3> cells = {};  ///< size of the box, each in [1, kMaxGridSide]
  std::uint32_t channels = 1;               ///< 1 or 3
  Format format = Format::kFloat32;
  Filter filter = Filter::kLinear;
  Border border = Border::kZero;
  /// From cell space to the space of the medium (scene/media.h); invertible.
  Transform to_medium;
  /// A uint32 for each brick of the box, x fastest: its place in `values`, or kEmptyBrick.
  SharedBytes index;
  /// Bricks, one after the other: the numbers of a brick's cells, x fastest, the channels of a cell
  /// together. Numbers of cells outside of the box are 0.
  SharedBytes values;

  friend bool operator==(const VolumeGrid&, const VolumeGrid&) = default;
};

/// Returns the number of bricks along each axis.
constexpr std::array<std::uint32_t, 3> brick_counts(const std::array<std::uint32_t, 3>& cells) {
  const auto bricks = [](std::uint32_t n) { return n / kBrickSide + (n % kBrickSide != 0); };
  return {bricks(cells[0]), bricks(cells[1]), bricks(cells[2])};
}

/// Returns the number of entries of the index. The sides MUST be at most kMaxGridSide.
constexpr std::uint64_t all_bricks(const std::array<std::uint32_t, 3>& cells) {
  const auto [x, y, z] = brick_counts(cells);
  return std::uint64_t{x} * y * z;
}

/// Returns the size of one stored brick in bytes.
constexpr std::uint64_t brick_bytes(std::uint32_t channels, VolumeGrid::Format format) {
  return std::uint64_t{kBrickCells} * channels * (format == VolumeGrid::Format::kFloat16 ? 2 : 4);
}

/// Returns the largest number of the grid. Returns INVALID_ARGUMENT if the sizes are out of range
/// or do not fit each other, an index or number is out of range, or a cell outside of the box is
/// not 0. The message begins with the field: ".index: …".
absl::StatusOr<float> check_grid(const VolumeGrid& grid);

/// Returns the number that a half (IEEE 754, 16 bits) has. The result is exact.
float half_to_float(std::uint16_t half);
/// Returns the half with the number `value`. If no half has this number, returns a half with
/// another number and sets `*exact` to false. Otherwise `*exact` does not change.
std::uint16_t float_to_half(float value, bool* exact);

/// Reads the numbers of a grid, which MUST be valid and outlive this object.
class GridReader {
 public:
  explicit GridReader(const VolumeGrid& grid);

  /// Returns the value at a point of cell space: 0 outside of the box. For a grid of three channels
  /// it is the value of the first channel.
  float value(const Vec3& at) const { return interpolate<1>(at)[0]; }
  /// Returns the value of three channels; for a grid of one channel, three equal ones.
  Rgb color(const Vec3& at) const;

  /// Returns the number of a cell in the box.
  float cell(std::uint32_t x, std::uint32_t y, std::uint32_t z, std::uint32_t channel = 0) const;

  std::uint32_t channels() const { return channels_; }
  const std::array<std::uint32_t, 3>& bricks() const { return bricks_; }
  /// Returns the place in VolumeGrid::values of the brick whose first cell is (8 x, 8 y, 8 z);
  /// kEmptyBrick if all its numbers are 0.
  std::uint32_t brick(std::uint32_t x, std::uint32_t y, std::uint32_t z) const;
  /// Returns one number of a stored brick. `brick` is a place that brick() returned, other than
  /// kEmptyBrick. `number` is cell * channels + channel, where the cells of the brick are counted x
  /// fastest.
  float stored(std::uint32_t brick, std::uint32_t number) const;

 private:
  template <std::uint32_t kChannels>
  std::array<float, kChannels> interpolate(const Vec3& at) const;
  /// Returns the numbers of a cell. For a cell outside of the box they follow from Border: 0, or
  /// the numbers of the nearest cell in the box.
  template <std::uint32_t kChannels>
  std::array<float, kChannels> cell_or_zero(const std::array<std::int32_t, 3>& at) const;

  std::array<std::uint32_t, 3> cells_;
  std::array<std::uint32_t, 3> bricks_;
  std::uint32_t channels_;
  bool half_;
  bool nearest_;
  bool clamp_;
  const std::byte* index_;
  const std::byte* values_;
};

}  // namespace bandsaw
