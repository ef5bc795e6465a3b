#pragma once

// Disables culling: all boxes become so large that every ray visits every leaf.
// Traversal::kBruteForce uses such trees, for tests and for `bandsaw study --every-object`.

#include "renderlib/accel/moving_nodes.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Changes the tree so that a ray traced through it tests all its primitives. The hits stay the
/// same, to the bit.
void disable_culling(WideTree& tree);
/// Does the same for nodes whose bounds move by `changes` (moving_nodes.h), and sets all changes to
/// zero. `changes` is empty if the nodes do not move.
void disable_culling(WideTree& tree, NodeChanges& changes);

}  // namespace bandsaw
