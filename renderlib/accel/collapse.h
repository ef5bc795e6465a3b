#pragma once

// The second step of a build: binary nodes taken together, eight children a node.

#include "absl/functional/function_ref.h"
#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// The cheapest wide tree that keeps the binary tree's leaves, by dynamic programming over how many
/// of eight slots each subtree gets (Ylitie, Karras, Laine 2017, "Efficient Incoherent Ray
/// Traversal on GPUs Through Compressed Wide BVHs", section 3.2). Calls make_leaf for each leaf in
/// the order of a walk, so that what it lays out lies in that order.
WideTree collapse(const BinaryTree& tree,
                  absl::FunctionRef<ChildRef(const BinaryNode& leaf)> make_leaf);

}  // namespace bandsaw
