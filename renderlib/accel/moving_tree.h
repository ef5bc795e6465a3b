#pragma once

// BVH over moving instances: boxes whose sides move linearly during the shutter interval.

#include "renderlib/accel/top_tree.h"
#include "renderlib/accel/traverse.h"
#include "renderlib/geometry/moving_bounds.h"

namespace bandsaw {

/// An instance that moves.
struct MovingInstance {
  Prototype prototype;
  std::uint32_t instance = 0;  ///< as in PrimitiveId
  /// True if it neither rotates nor scales: the linear part of its placement is constant, and so is
  /// that of its inverse, which is stored in `to_object`.
  bool slides = false;
  Transform to_object;
};

struct MovingTree {
  /// Difference of a node's bounds between the end and the beginning of the interval.
  using Change = std::array<std::array<float, WideNode::kChildren>, 6>;

  WideTree tree;  ///< bounds at the beginning; its `reach` covers all times
  HugeVector<Change> change;
  std::vector<MovingInstance> moving;
  Interval interval;

  std::size_t bytes() const {
    return tree.bytes() + change.capacity() * sizeof(Change) +
           moving.capacity() * sizeof(MovingInstance);
  }
  /// Returns the position of a time within the interval, in [0, 1].
  float share(double time) const {
    const double u = (time - interval.open) / (interval.close - interval.open);
    return u > 0 ? u < 1 ? static_cast<float>(u) : 1.0f : 0.0f;
  }
};

MovingTree build_moving_tree(const Geometry& geometry, const Prototypes& prototypes,
                             const Interval& interval, Pool* pool);

/// The same as enter_children() (accel/traverse.h) for node `index` at `share` of the interval.
template <class Float = Float8>
inline unsigned enter_moving_children(const MovingTree& tree, std::uint32_t index, float share,
                                      const FloatRay& ray, float bound, Float& enter) {
  const WideNode& node = tree.tree.nodes[index];
  const char* const change = reinterpret_cast<const char*>(&tree.change[index]);
  const auto plane = [&](std::size_t bytes) {
    return fused(Float::load(reinterpret_cast<const float*>(change + bytes)), Float(share),
                 Float::load(node.plane(bytes)));
  };
  Float first(0.0f);
  Float last(bound);
  for (std::size_t k = 0; k < 3; ++k) {
    const Float in =
        fused(plane(ray.near[k]), Float(ray.near_factor[k]), Float(ray.near_offset[k]));
    const Float out = fused(plane(ray.far[k]), Float(ray.far_factor[k]), Float(ray.far_offset[k]));
    first = max(in, first);
    last = min(out, last);
  }
  enter = first;
  return (first <= last).bits();
}

}  // namespace bandsaw
