#pragma once

// Trees without their use: boxes that bound nothing, so that every ray comes to every leaf. What a
// tree is compared with.

#include "renderlib/accel/moving_tree.h"
#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// From now on a ray that is traced through the tree is tested against all that it holds. What it
/// finds stays the same, to the bit.
void open_boxes(WideTree& tree);
void open_boxes(MovingTree& tree);

}  // namespace bandsaw
