#pragma once

// Second step of a build: collapses binary nodes into nodes with eight children.

#include "absl/functional/function_ref.h"
#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Returns the cheapest wide tree that keeps the binary tree's leaves, by dynamic programming over
/// how many of eight slots each subtree gets (Ylitie, Karras and Laine 2017, "Efficient Incoherent
/// Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.2). Calls make_leaf for each leaf
/// in depth-first order, so that the leaves' data are stored in that order.
WideTree collapse(const BinaryTree& tree,
                  absl::FunctionRef<ChildRef(const BinaryNode& leaf)> make_leaf);

}  // namespace bandsaw
