#pragma once

// BVH over moving instances: boxes whose sides move linearly during the shutter interval.

#include "renderlib/accel/moving_nodes.h"
#include "renderlib/accel/top_tree.h"
#include "renderlib/geometry/moving_bounds.h"

namespace bandsaw {

/// An instance that moves with an animated frame (geometry/frame.h).
struct MovingInstance {
  Prototype prototype;
  std::uint32_t instance = 0;  ///< as in PrimitiveId
  /// True if the instance neither rotates nor scales. In this case the linear part of its placement
  /// is constant, and the inverse of the placement has the linear part of `to_object` at all times.
  bool slides = false;
  Transform to_object;  ///< from the world to the prototype when the shutter opens
};

struct MovingTree {
  /// Has the bounds at the time when the shutter opens. Its `reach`, the largest absolute
  /// coordinate of any bound, covers all times.
  WideTree tree;
  NodeChanges changes;                 ///< how far each bound moves until the shutter closes
  std::vector<MovingInstance> moving;  ///< by the index of the leaf

  std::size_t bytes() const {
    return tree.bytes() + changes.capacity() * sizeof(NodeChanges::value_type) +
           moving.capacity() * sizeof(MovingInstance);
  }
};

/// Builds the tree over the instances that move. Its boxes are valid at all times of
/// Geometry::shutter.
MovingTree build_moving_tree(const Geometry& geometry, const Prototypes& prototypes, Pool* pool);

}  // namespace bandsaw
