// Reads *.vdb files with the library OpenVDB: fog volumes of floats, halves, doubles or vectors of
// three floats. The numbers are stored in bricks, which are cubes of 8 x 8 x 8 cells. Everything
// happens on the calling thread, because the library starts no thread for reading. Cross-compiled
// programs are built without OpenVDB.

#ifndef BANDSAW_NO_OPENVDB

#include <openvdb/openvdb.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/import/volume/volume_file.h"
#include "renderlib/medium/brick_builder.h"

namespace bandsaw {
namespace {

static_assert(openvdb::FloatTree::LeafNodeType::DIM == kBrickSide, "a leaf is a brick");

absl::Status invalid(absl::string_view what) { return absl::InvalidArgumentError(what); }

/// Returns the channels of a voxel.
std::array<float, 1> numbers_of(float value) { return {value}; }
std::array<float, 1> numbers_of(double value) { return {static_cast<float>(value)}; }
std::array<float, 3> numbers_of(const openvdb::Vec3s& v) { return {v[0], v[1], v[2]}; }

/// A box of voxels, from `low` to below `high`.
struct VoxelBox {
  std::array<std::int64_t, 3> low;
  std::array<std::int64_t, 3> high;
};

/// Returns the box of whole bricks around all active voxels, including those of tiles, which are
/// larger cubes of one value. The box has at least one more voxel on each side, because
/// interpolated values reach that far beyond the active voxels. Returns std::nullopt if there are
/// no active voxels.
template <class Tree>
std::optional<VoxelBox> box_of(const Tree& tree) {
  openvdb::CoordBBox active;
  if (!tree.evalActiveVoxelBoundingBox(active)) {
    return std::nullopt;
  }
  VoxelBox box;
  for (int k = 0; k < 3; ++k) {
    const std::int64_t low = std::int64_t{active.min()[k]} - 1;
    const std::int64_t high = std::int64_t{active.max()[k]} + 2;
    const auto axis = static_cast<std::size_t>(k);
    box.low[axis] = low & ~std::int64_t{kBrickSide - 1};
    box.high[axis] = (high + kBrickSide - 1) & ~std::int64_t{kBrickSide - 1};
  }
  return box;
}

/// Returns RESOURCE_EXHAUSTED if a box is too long along an axis or has too many bricks.
absl::Status check_box(const VoxelBox& box) {
  std::uint64_t bricks = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::int64_t side = box.high[k] - box.low[k];
    if (side > kMaxGridSide) {
      return absl::ResourceExhaustedError(absl::StrCat("spans ", side, " voxels along axis ", k,
                                                       ", at most ", kMaxGridSide, " are read"));
    }
    bricks *= static_cast<std::uint64_t>(side) / kBrickSide;
  }
  return bricks <= kMaxGridBricks ? absl::OkStatus()
                                  : absl::ResourceExhaustedError(absl::StrCat(
                                        "spans ", bricks, " bricks of 8 x 8 x 8 voxels, at most ",
                                        kMaxGridBricks, " are read"));
}

/// Copies a tree's active voxels to bricks.
template <class Tree>
class Copy {
 public:
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Tree::ValueType;
  static constexpr std::uint32_t kChannels = std::tuple_size_v<decltype(numbers_of(Value()))>;

  Copy(const VoxelBox& box, const std::array<std::uint32_t, 3>& cells)
      : box_(box), builder_(cells, kChannels), brick_(kBrickCells * kChannels) {}

  absl::Status run(const Tree& tree) {
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) {
      RETURN_IF_ERROR(add(*leaf));
    }
    // The values of leaves are at depth Tree::DEPTH - 1, so the iterator stops one level above
    // them.
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(static_cast<openvdb::Index>(Tree::DEPTH) - 2);
    for (; tile; ++tile) {
      // The iterator is made before it knows its depth, so it may begin at a voxel of a leaf.
      if (tile.isTileValue()) {
        RETURN_IF_ERROR(add_tile(tile.getBoundingBox(), *tile));
      }
    }
    return absl::OkStatus();
  }

  VolumeGrid grid() && { return std::move(builder_).build(); }
  std::uint64_t negative() const { return negative_; }

 private:
  /// Writes the numbers of the voxel `at` into a cell of `brick_`. Numbers below 0 become 0.
  /// Returns INVALID_ARGUMENT if a number is not finite.
  absl::Status put(std::uint32_t cell, const Value& value, const openvdb::Coord& at) {
    const auto numbers = numbers_of(value);
    for (std::uint32_t c = 0; c < kChannels; ++c) {
      if (!std::isfinite(numbers[c])) {
        return invalid(absl::StrCat("voxel [", at.x(), ", ", at.y(), ", ", at.z(), "] is ",
                                    numbers[c], ", not finite"));
      }
      negative_ += numbers[c] < 0 ? 1 : 0;
      brick_[cell * kChannels + c] = std::max(numbers[c], 0.0f);
    }
    return absl::OkStatus();
  }

  /// Stores `brick_` as the brick whose first voxel is `first`.
  void set(const openvdb::Coord& first) {
    const auto brick = [&](int k) {
      const std::int64_t from = first[k] - box_.low[static_cast<std::size_t>(k)];
      return static_cast<std::uint32_t>(from / kBrickSide);
    };
    builder_.set(brick(0), brick(1), brick(2), brick_);
  }

  absl::Status add(const Leaf& leaf) {
    std::fill(brick_.begin(), brick_.end(), 0.0f);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord local = Leaf::offsetToLocalCoord(voxel.pos());
      const auto cell = static_cast<std::uint32_t>((local.z() * 8 + local.y()) * 8 + local.x());
      RETURN_IF_ERROR(put(cell, *voxel, leaf.origin() + local));
    }
    set(leaf.origin());
    return absl::OkStatus();
  }

  /// Adds a tile. All of its bricks are equal, so `brick_` is filled only once.
  absl::Status add_tile(const openvdb::CoordBBox& tile, const Value& value) {
    for (std::uint32_t cell = 0; cell < kBrickCells; ++cell) {
      RETURN_IF_ERROR(put(cell, value, tile.min()));
    }
    const openvdb::Coord low = tile.min();
    const openvdb::Coord high = tile.max();
    for (int z = low.z(); z <= high.z(); z += 8) {
      for (int y = low.y(); y <= high.y(); y += 8) {
        for (int x = low.x(); x <= high.x(); x += 8) {
          set({x, y, z});
        }
      }
    }
    return absl::OkStatus();
  }

  VoxelBox box_;
  BrickBuilder builder_;
  std::vector<float> brick_;
  std::uint64_t negative_ = 0;
};

/// Returns the map from the cells of a VolumeGrid to the space of the file's transform `map`. The
/// first cell is voxel `first` of the file. Returns INVALID_ARGUMENT if `map` is not affine or is
/// singular.
absl::StatusOr<Transform> to_file_space(const openvdb::math::Transform& map,
                                        const std::array<std::int64_t, 3>& first) {
  if (!map.isLinear()) {
    return invalid("has a transform that is not affine (a frustum): not read");
  }
  const openvdb::Mat4d rows = map.baseMap()->getAffineMap()->getMat4();
  Transform to_world;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) {
      // The library multiplies a row vector by the matrix, so its matrix is transposed.
      to_world.m[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)] =
          rows(column, row);
    }
  }
  // In the file, the value of a voxel belongs to the point at its index i. In a VolumeGrid, it
  // belongs to the centre of its cell, i + 1/2.
  const auto at = [&](std::size_t k) { return static_cast<double>(first[k]) - 0.5; };
  const Transform result = to_world * translation({at(0), at(1), at(2)});
  return inverse(to_world) ? absl::StatusOr<Transform>(result)
                           : invalid("has a transform that is singular");
}

/// Converts a grid of the library. Returns INVALID_ARGUMENT if it is a level set or holds an
/// invalid number or transform, and RESOURCE_EXHAUSTED if it is too large.
template <class Grid>
absl::StatusOr<FileGrid> convert(const Grid& grid) {
  using Tree = typename Grid::TreeType;
  if (grid.getGridClass() == openvdb::GRID_LEVEL_SET) {
    return invalid(
        "is a level set: distances to a surface. Convert it to a fog volume (in Houdini: Convert "
        "VDB; in code: openvdb::tools::sdfToFogVolume)");
  }
  const Tree& tree = grid.tree();
  FileGrid result;
  const std::optional<VoxelBox> found = box_of(tree);
  // A grid without active voxels is 0 everywhere.
  const VoxelBox box = found.value_or(VoxelBox{{0, 0, 0}, {8, 8, 8}});
  RETURN_IF_ERROR(check_box(box));
  std::array<std::uint32_t, 3> cells;
  for (std::size_t k = 0; k < 3; ++k) {
    cells[k] = static_cast<std::uint32_t>(box.high[k] - box.low[k]);
  }
  Copy<Tree> copy(box, cells);
  if (found) {
    RETURN_IF_ERROR(copy.run(tree));
  }
  result.negative = copy.negative();
  result.grid = std::move(copy).grid();
  ASSIGN_OR_RETURN(result.grid.to_medium, to_file_space(grid.transform(), box.low));
  return result;
}

/// Returns the name of the grid to read. `names` are the names of all grids of the file. The result
/// is `grid`, unless `grid` is empty. In that case it is `otherwise` if the file has such a grid,
/// or else the only grid of the file. Returns INVALID_ARGUMENT if there is no grid to read.
absl::StatusOr<std::string> choose(const std::vector<std::string>& names, const std::string& grid,
                                   const std::string& otherwise) {
  const std::string& wanted = grid.empty() ? otherwise : grid;
  if (std::find(names.begin(), names.end(), wanted) != names.end()) {
    return wanted;
  }
  if (grid.empty() && names.size() == 1) {
    return names.front();
  }
  if (names.empty()) {
    return invalid("has no grids");
  }
  return invalid(absl::StrCat("has no grid called \"", wanted, "\"; it has \"",
                              absl::StrJoin(names, "\", \""), "\""));
}

/// Does what read_vdb() does, but may throw exceptions of the library.
absl::StatusOr<FileGrid> read(const std::string& path, const std::string& grid,
                              const std::string& otherwise) {
  openvdb::initialize();
  openvdb::io::File file(path);
  file.setCopyMaxBytes(0);
  file.open(/*delayLoad=*/false);
  std::vector<std::string> names;
  for (auto name = file.beginName(); name != file.endName(); ++name) {
    names.push_back(name.gridName());
  }
  ASSIGN_OR_RETURN(const std::string wanted, choose(names, grid, otherwise));
  const openvdb::GridBase::Ptr found = file.readGrid(wanted);
  if (const auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(found)) {
    return convert(*floats);
  }
  if (const auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(found)) {
    return convert(*doubles);
  }
  if (const auto vectors = openvdb::gridPtrCast<openvdb::Vec3SGrid>(found)) {
    return convert(*vectors);
  }
  return invalid(absl::StrCat("grid \"", wanted, "\" is of type ", found->type(),
                              "; only float, double and vec3s can be read"));
}

}  // namespace

absl::StatusOr<FileGrid> read_vdb(const std::string& path, const std::string& grid,
                                  const std::string& otherwise) {
  try {
    return read(path, grid, otherwise);
  } catch (const openvdb::Exception& error) {
    return invalid(
        absl::StrCat("is no OpenVDB file that can be read, or is damaged (", error.what(), ")"));
  }
}

}  // namespace bandsaw

#else

#include "absl/status/status.h"
#include "renderlib/import/volume/volume_file.h"

namespace bandsaw {

absl::StatusOr<FileGrid> read_vdb(const std::string& /*path*/, const std::string& /*grid*/,
                                  const std::string& /*otherwise*/) {
  return absl::InvalidArgumentError(
      "is an OpenVDB file, which this cross-compiled program does not read: import the scene on a "
      "machine where the programs are not cross-compiled");
}

}  // namespace bandsaw

#endif
