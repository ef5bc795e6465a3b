#pragma once

// First step of a build: a binary BVH whose leaves fit into one pack.

#include <cstdint>
#include <vector>

#include "renderlib/accel/float_box.h"
#include "renderlib/accel/tree_item.h"
#include "renderlib/base/pool.h"

namespace bandsaw {

struct BinaryNode {
  FloatBox box;
  std::uint32_t first = 0;  ///< first item of a leaf, in BinaryTree::items
  std::uint32_t count = 0;  ///< number of items of a leaf; 0: an inner node
  std::uint32_t left = 0;
  std::uint32_t right = 0;
};

struct BinaryTree {
  std::vector<BinaryNode> nodes;  ///< root first; empty if there are no items
  HugeVector<ItemRef> items;
};

/// Maximum number of items of a leaf: a pack of primitives. A leaf of instances has one.
inline constexpr std::uint32_t kPackSize = 8;

/// Builds the tree by the binned surface area heuristic (Wald 2007, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies"), with items counted in packs. Items whose box cannot be
/// hit MUST have been removed. The depth is at most kMaxTreeDepth. The result is the same for any
/// number of threads; if `pool` is null, the build runs on this thread.
BinaryTree build_binary_tree(TreeItems items, Pool* pool);

}  // namespace bandsaw
