#pragma once

// Disables culling: all boxes become infinite, so that every ray visits every leaf. A reference for
// tests.

#include "renderlib/accel/moving_tree.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Makes a ray traced through the tree test all primitives in it. The hits stay the same, to the
/// bit.
void disable_culling(WideTree& tree);
void disable_culling(MovingTree& tree);

}  // namespace bandsaw
