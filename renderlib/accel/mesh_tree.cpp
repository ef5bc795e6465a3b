// Makes an item (a box with the triangle's number) for each triangle that can be hit. Then builds a
// binary tree of the items and collapses it to a tree with eight children per node. Each leaf is a
// pack, into which the corners of its triangles, at most eight, are copied.

#include "renderlib/accel/mesh_tree.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// Number of triangles or leaves that a thread handles at a time; results do not depend on it.
constexpr std::size_t kPieceSize = std::size_t{1} << 14;

/// Calls body(first, end) for pieces that cover [0, count), in parallel if there is a pool.
void in_pieces(std::size_t count, Pool* pool,
               absl::FunctionRef<void(std::size_t, std::size_t)> body) {
  if (pool == nullptr) {
    body(0, count);
    return;
  }
  const std::size_t pieces = (count + kPieceSize - 1) / kPieceSize;
  pool->parallel_for(static_cast<std::int64_t>(pieces), [&](std::int64_t i) {
    const std::size_t first = static_cast<std::size_t>(i) * kPieceSize;
    body(first, std::min(count, first + kPieceSize));
  });
}

using Positions = std::vector<std::array<float, 3>>;

FlatPacker::Corners corners_of(const Mesh& mesh, const Positions& positions, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {positions[a], positions[b], positions[c]};
}

FloatBox box_of(const FlatPacker::Corners& corners) {
  FloatBox box;
  for (const std::array<float, 3>& corner : corners) {
    box.add({corner, corner});
  }
  return box;
}

bool all_finite(const FlatPacker::Corners& corners) {
  return std::all_of(corners.begin(), corners.end(), [](const std::array<float, 3>& corner) {
    return std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
  });
}

/// Returns the box of a triangle of a mesh that deforms, at the middle of the shutter interval. The
/// box is empty if build_mesh_tree() omits the triangle.
FloatBox middle_bounds(const FlatPacker::Corners& open, const FlatPacker::Corners& close) {
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t next = (i + 1) % 3;
    if (open[i] == open[next] && close[i] == close[next]) {
      return {};
    }
  }
  FlatPacker::Corners change{};
  FlatPacker::Corners halfway{};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      change[i][k] = close[i][k] - open[i][k];  // computed as in ShutterTime; it may overflow
      halfway[i][k] = 0.5f * open[i][k] + 0.5f * close[i][k];
    }
  }
  return all_finite(open) && all_finite(close) && all_finite(change) ? box_of(halfway) : FloatBox{};
}

/// Returns the box of a triangle; it is empty if build_mesh_tree() omits the triangle.
FloatBox bounds(const Mesh& mesh, std::size_t triangle) {
  const auto& indices = mesh.triangles[triangle];
  if (*std::max_element(indices.begin(), indices.end()) >= mesh.positions.size()) {
    return {};
  }
  const FlatPacker::Corners corners = corners_of(mesh, mesh.positions, triangle);
  if (deforms(mesh)) {
    return middle_bounds(corners, corners_of(mesh, mesh.positions_at_close, triangle));
  }
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
    return {};
  }
  return all_finite(corners) ? box_of(corners) : FloatBox{};
}

/// Returns an item for each triangle that can be hit; its index is that of the triangle.
TreeItems items_of(const Mesh& mesh, Pool* pool) {
  TreeItems items(mesh.triangles.size());
  std::atomic<bool> all_can_be_hit = true;
  in_pieces(items.size(), pool, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      items[i] = {bounds(mesh, i), static_cast<std::uint32_t>(i)};
      if (!items[i].can_be_hit()) {
        all_can_be_hit = false;
      }
    }
  });
  if (!all_can_be_hit) {
    std::erase_if(items, [](const TreeItem& item) { return !item.can_be_hit(); });
  }
  return items;
}

/// A leaf: a range of BinaryTree::items.
struct Leaf {
  std::uint32_t first;
  std::uint32_t count;
};

/// Fills the packs of `tree`, one for each leaf, with the triangles of the leaf.
void fill_packs(const Mesh& mesh, const BinaryTree& binary, const std::vector<Leaf>& leaves,
                Pool* pool, MeshTree& tree) {
  tree.packs.resize(leaves.size());
  if (deforms(mesh)) {
    tree.corners_at_close.resize(leaves.size(), {});
  }
  in_pieces(leaves.size(), pool, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      FlatPacker packer(tree.packs[i]);
      for (std::uint32_t k = 0; k < leaves[i].count; ++k) {
        const std::uint32_t triangle = binary.items[leaves[i].first + k].index;
        const FlatPacker::Corners corners = corners_of(mesh, mesh.positions, triangle);
        if (deforms(mesh)) {
          packer.add_moving(corners, corners_of(mesh, mesh.positions_at_close, triangle), triangle,
                            tree.corners_at_close[i]);
        } else {
          packer.add(corners, triangle);
        }
      }
    }
  });
}

/// Returns the bounds of the used lanes of a pack.
Box box_of(const FlatPack::Corners& corners, std::uint32_t lanes) {
  Box box;
  for (std::size_t lane = 0; lane < kPackSize; ++lane) {
    for (std::size_t which = 0; which < 3 && (lanes >> lane & 1u) != 0; ++which) {
      box.add(
          {corners[3 * which][lane], corners[3 * which + 1][lane], corners[3 * which + 2][lane]});
    }
  }
  return box;
}

}  // namespace

FlatPack pack_at(const MeshTree& mesh, std::uint32_t index, const ShutterTime& now) {
  FlatPack pack = mesh.packs[index];
  const FlatPack::Corners& at_close = mesh.corners_at_close[index];
  const Float8 factor(now.factor);
  // These are the operations of ShutterTime::between(), so that the corners have the same bits.
  for (std::size_t row = 0; row < pack.corner.size(); ++row) {
    const Float8 open = Float8::load(pack.corner[row].data());
    const Float8 close = Float8::load(at_close[row].data());
    fused(close - open, factor, now.from_close ? close : open).store(pack.corner[row].data());
  }
  return pack;
}

MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool) {
  BANDSAW_CHECK(mesh.triangles.size() <= kMaxTreeItems,
                "scene/check_counts.h refuses more triangles");
  MeshTree result;
  const BinaryTree binary = build_binary_tree(items_of(mesh, pool), pool);
  if (binary.nodes.empty()) {
    return result;
  }
  std::vector<Leaf> leaves;
  result.tree = collapse(binary, [&leaves](const BinaryNode& leaf) {
    leaves.push_back({leaf.first, leaf.count});
    return ChildRef::leaf(LeafKind::kFlats, static_cast<std::uint32_t>(leaves.size() - 1));
  });
  fill_packs(mesh, binary, leaves, pool, result);
  if (deforms(mesh)) {
    const auto box_of_leaf = [&](ChildRef leaf) {
      const FlatPack& pack = result.packs[leaf.leaf_index()];
      const MovingBox box = {box_of(pack.corner, pack.lanes),
                             box_of(result.corners_at_close[leaf.leaf_index()], pack.lanes)};
      result.box = both(result.box, both(box.at_open, box.at_close));
      return box;
    };
    result.changes = set_moving_bounds(box_of_leaf, result.tree);
    return result;
  }
  const FloatBox& box = binary.nodes[0].box;
  result.box.add({box.lo[0], box.lo[1], box.lo[2]});
  result.box.add({box.hi[0], box.hi[1], box.hi[2]});
  return result;
}

}  // namespace bandsaw
