#pragma once

// First step of the build of a BVH: a binary tree over items (boxes with an index, tree_item.h). A
// leaf is one instance or one pack, i.e. up to eight primitives of one kind that a ray tests
// together. The second step (collapse.h) makes a tree with eight children per node from it.

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
  std::uint32_t left = 0;   ///< index of a child; only of an inner node
  std::uint32_t right = 0;  ///< index of a child; only of an inner node
};

struct BinaryTree {
  std::vector<BinaryNode> nodes;  ///< root first, parents before children; or empty
  HugeVector<ItemRef> items;
};

/// Maximum number of items of a leaf of primitives. A leaf of instances has one item.
inline constexpr std::uint32_t kPackSize = 8;

/// Builds the tree by the binned surface area heuristic (Wald 2007, "On fast Construction of
/// SAH-based Bounding Volume Hierarchies"); the cost of a box is its area times the number of packs
/// that its items need. Items whose box cannot be hit (TreeItem::can_be_hit) MUST have been
/// removed. The depth is at most kMaxTreeDepth. The tree is the same for any number of threads; if
/// `pool` is null, the build runs on this thread.
BinaryTree build_binary_tree(TreeItems items, Pool* pool);

}  // namespace bandsaw
