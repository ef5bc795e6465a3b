#pragma once

// Capacity of one BVH. Validation refuses larger geometry (scene/check_counts.h); building a BVH
// asserts it.

#include <cstddef>

#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Maximum number of items in one BVH: the triangles of a mesh, the shapes of a group, or the loose
/// shapes and instances of a scene. A quad is two items, one for each half. Leaves are numbered in
/// 29 bits.
inline constexpr std::size_t kMaxTreeItems = ChildRef::kMaxLeaves - 1;

}  // namespace bandsaw
