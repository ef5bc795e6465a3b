#pragma once

// Capacity of one BVH. Validation refuses larger geometry (scene/check_counts.h). The functions
// that build a BVH assert that the capacity is not exceeded.

#include <cstddef>

#include "renderlib/accel/wide_tree.h"

namespace bandsaw {

/// Maximum number of items in one BVH: the triangles of a mesh, the shapes of a group, or the loose
/// shapes and instances of a scene. A quad is two items, one for each half. Leaves are numbered in
/// 29 bits.
inline constexpr std::size_t kMaxTreeItems = ChildRef::kMaxLeaves - 1;

}  // namespace bandsaw
