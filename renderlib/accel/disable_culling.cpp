// Replaces the bounds of all children by boxes that every ray enters, so that a traversal visits
// every node.

#include "renderlib/accel/disable_culling.h"

#include <algorithm>
#include <cstddef>
#include <limits>

namespace bandsaw {
namespace {

// The number is finite, because infinite planes would give NaN for rays parallel to them.
constexpr float kFarthest = std::numeric_limits<float>::max();

/// Returns whether the slot `child` of the node is used. An unused slot has empty bounds (lo > hi),
/// which are not changed.
bool used(const WideNode& node, std::size_t child) {
  return node.bounds[0][child] <= node.bounds[3][child];
}

/// Replaces the bounds of the child by a box that every ray enters.
void open(WideNode& node, std::size_t child) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    node.bounds[axis][child] = -kFarthest;
    node.bounds[axis + 3][child] = kFarthest;
  }
}

}  // namespace

void disable_culling(WideTree& tree) {
  for (WideNode& node : tree.nodes) {
    for (std::size_t child = 0; child < WideNode::kChildren; ++child) {
      if (used(node, child)) {
        open(node, child);
      }
    }
  }
}

void disable_culling(WideTree& tree, NodeChanges& changes) {
  disable_culling(tree);
  std::fill(changes.begin(), changes.end(), NodeChanges::value_type{});
}

}  // namespace bandsaw
