#pragma once

// Second step of the build of every BVH (mesh_tree, shapes_tree, top_tree, moving_tree): collapses
// binary nodes into nodes with eight children.

#include "absl/functional/function_ref.h"
#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Returns the cheapest wide tree that keeps the binary tree's leaves. Dynamic programming finds
/// how many of the eight slots of a wide node each subtree gets (Ylitie, Karras and Laine 2017,
/// "Efficient Incoherent Ray Traversal on GPUs Through Compressed Wide BVHs", section 3.2).
/// make_leaf(leaf) stores the primitives of a leaf and returns the reference to it. It is called
/// once for each leaf, in depth-first order.
WideTree collapse(const BinaryTree& tree,
                  absl::FunctionRef<ChildRef(const BinaryNode& leaf)> make_leaf);

}  // namespace bandsaw
