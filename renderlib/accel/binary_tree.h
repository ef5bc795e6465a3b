#pragma once

// The first step of a build: items sorted into a binary tree whose leaves fit one pack.

#include <cstdint>
#include <vector>

#include "renderlib/accel/float_box.h"
#include "renderlib/accel/tree_item.h"
#include "renderlib/base/pool.h"

namespace bandsaw {

struct BinaryNode {
  FloatBox box;
  std::uint32_t first = 0;  ///< a leaf's items, in the order of BinaryTree::items
  std::uint32_t count = 0;  ///< 0: an inner node
  std::uint32_t left = 0;
  std::uint32_t right = 0;
};

struct BinaryTree {
  std::vector<BinaryNode> nodes;  ///< the root first; empty: no items
  HugeVector<ItemRef> items;
};

/// How many items a leaf holds at most: a pack of primitives, or one instance.
inline constexpr std::uint32_t kPackSize = 8;

/// Binned surface area heuristic (Wald 2007, "On fast Construction of SAH-based Bounding Volume
/// Hierarchies") with items counted in packs. Items whose box cannot be hit MUST have been left
/// out. Depth at most kMaxDepth. The same for any number of threads; `pool` null: on this thread.
BinaryTree build_binary_tree(TreeItems items, Pool* pool);

}  // namespace bandsaw
