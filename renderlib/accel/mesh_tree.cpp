#include "renderlib/accel/mesh_tree.h"

#include <algorithm>
#include <atomic>
#include <vector>

#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

constexpr std::size_t kPieceSize = std::size_t{1} << 14;

/// Calls body(first, end) for pieces of [0, count).
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

FlatPacker::Corners corners_of(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return {mesh.positions[a], mesh.positions[b], mesh.positions[c]};
}

/// Returns an empty box if the triangle is omitted.
FloatBox bounds(const Mesh& mesh, std::size_t triangle) {
  const auto& indices = mesh.triangles[triangle];
  if (*std::max_element(indices.begin(), indices.end()) >= mesh.positions.size()) {
    return {};
  }
  const FlatPacker::Corners corners = corners_of(mesh, triangle);
  if (corners[0] == corners[1] || corners[1] == corners[2] || corners[2] == corners[0]) {
    return {};
  }
  FloatBox box;
  bool finite = true;
  for (const std::array<float, 3>& corner : corners) {
    box.add({corner, corner});
    finite =
        finite && std::isfinite(corner[0]) && std::isfinite(corner[1]) && std::isfinite(corner[2]);
  }
  return finite ? box : FloatBox{};
}

TreeItems items_of(const Mesh& mesh, Pool* pool) {
  TreeItems items(mesh.triangles.size());
  std::atomic<bool> all = true;
  in_pieces(items.size(), pool, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      items[i] = {bounds(mesh, i), static_cast<std::uint32_t>(i)};
      if (!items[i].can_be_hit()) {
        all = false;
      }
    }
  });
  if (!all) {
    std::erase_if(items, [](const TreeItem& item) { return !item.can_be_hit(); });
  }
  return items;
}

}  // namespace

MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool) {
  BANDSAW_CHECK(mesh.triangles.size() <= kMaxTreeItems, "scene/check_counts.h refuses more");
  MeshTree result;
  const BinaryTree binary = build_binary_tree(items_of(mesh, pool), pool);
  if (binary.nodes.empty()) {
    return result;
  }
  const FloatBox& box = binary.nodes[0].box;
  result.box.add({box.lo[0], box.lo[1], box.lo[2]});
  result.box.add({box.hi[0], box.hi[1], box.hi[2]});
  struct Leaf {
    std::uint32_t first;
    std::uint32_t count;
  };
  std::vector<Leaf> leaves;
  result.tree = collapse(binary, [&leaves](const BinaryNode& leaf) {
    leaves.push_back({leaf.first, leaf.count});
    return ChildRef::leaf(LeafKind::kFlats, static_cast<std::uint32_t>(leaves.size() - 1));
  });
  result.packs.resize(leaves.size());
  in_pieces(leaves.size(), pool, [&](std::size_t first, std::size_t end) {
    for (std::size_t i = first; i < end; ++i) {
      FlatPacker packer(result.packs[i]);
      for (std::uint32_t k = 0; k < leaves[i].count; ++k) {
        const std::uint32_t triangle = binary.items[leaves[i].first + k].index;
        packer.add(corners_of(mesh, triangle), triangle);
      }
    }
  });
  return result;
}

}  // namespace bandsaw
