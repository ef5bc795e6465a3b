#pragma once

// Bounding boxes whose sides move linearly during the shutter interval. The nodes of two kinds of
// BVH have such boxes: the BVH over all moving instances (moving_tree.h), and the BVHs of meshes
// that deform (mesh_tree.h).

#include <array>
#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/accel/float_ray.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/huge_vector.h"
#include "renderlib/base/simd.h"
#include "renderlib/geometry/moving_bounds.h"

namespace bandsaw {

/// Element [node][row][child] is the change of WideNode::bounds[row][child] from the beginning to
/// the end of the interval. The tree itself has the bounds at the beginning. Its `reach`, the
/// largest absolute coordinate of any bound, is valid for all times. (FloatRay uses `reach` to
/// bound rounding errors.)
using NodeChanges = HugeVector<std::array<std::array<float, WideNode::kChildren>, 6>>;

/// Returns a box that contains both.
Box both(const Box& a, const Box& b);
/// Returns the box at the middle of the interval. Trees are built from these boxes.
Box middle(const MovingBox& box);

/// Replaces the bounds of all nodes by those at the beginning of the interval, and sets tree.reach.
/// Returns the changes of the bounds until the end of the interval. leaf_box(leaf) returns the
/// bounds of a leaf at both ends. The stored bounds have a margin: even when they are interpolated
/// in float, the box of a node contains the boxes of its leaves at all times (README.md, "Moving
/// boxes").
NodeChanges set_moving_bounds(absl::FunctionRef<MovingBox(ChildRef leaf)> leaf_box, WideTree& tree);

/// Does for moving boxes what enter_children() (accel/traverse.h) does for boxes that rest. Returns
/// the mask of the children of node `index` that the ray enters before `bound` (in the ray's
/// units), and sets `enter` to the distances at which it enters them. The time is `share` of the
/// interval, in [0, 1].
template <class Float = Float8>
inline unsigned enter_moving_children(const WideTree& tree, const NodeChanges& changes,
                                      std::uint32_t index, float share, const FloatRay& ray,
                                      float bound, Float& enter) {
  const WideNode& node = tree.nodes[index];
  const char* const change = reinterpret_cast<const char*>(&changes[index]);
  const auto plane = [&](std::size_t bytes) {
    return about_fused(Float::load(reinterpret_cast<const float*>(change + bytes)), Float(share),
                       Float::load(node.plane(bytes)));
  };
  Float first(0.0f);
  Float last(bound);
  for (std::size_t k = 0; k < 3; ++k) {
    const Float in =
        about_fused(plane(ray.near[k]), Float(ray.near_factor[k]), Float(ray.near_offset[k]));
    const Float out =
        about_fused(plane(ray.far[k]), Float(ray.far_factor[k]), Float(ray.far_offset[k]));
    first = max(in, first);
    last = min(out, last);
  }
  enter = first;
  return (first <= last).bits();
}

}  // namespace bandsaw
