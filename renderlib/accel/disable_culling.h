#pragma once

// Disables culling: all boxes become infinite, so that every ray visits every leaf. A reference for
// tests.

#include "renderlib/accel/moving_nodes.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Makes a ray traced through the tree test all primitives in it. The hits stay the same, to the
/// bit.
void disable_culling(WideTree& tree);
/// The same for nodes that move by `changes`; empty if they do not move.
void disable_culling(WideTree& tree, NodeChanges& changes);

}  // namespace bandsaw
