#pragma once

// How much one tree can hold. Whoever takes geometry from outside refuses more
// (scene/check_counts.h): a build asserts it.

#include <cstddef>

#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Items of one tree: of a mesh its triangles; of a group its shapes; of a scene its loose shapes
/// and its instances. A quad is two items, one for each half. Leaves are numbered in 29 bits.
inline constexpr std::size_t kMaxTreeItems = ChildRef::kMaxLeaves - 1;

}  // namespace bandsaw
