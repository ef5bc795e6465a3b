// Sets the bounds of a tree for both ends of the shutter interval, leaves first. Between the ends
// the bounds are interpolated in float, so they have a margin for the rounding of the
// interpolation.

#include "renderlib/accel/moving_nodes.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderlib/accel/float_box.h"

namespace bandsaw {
namespace {

/// If a bound and a vertex within it are interpolated in float, the error is at most 7u times the
/// larger absolute value of the bound at the two ends, where u is 2^-24 (README.md, "Moving
/// boxes").
constexpr double kLerpError = 8 * 0x1p-24;
/// Covers the underflow of floats.
constexpr double kTiny = 0x1p-120;

/// Implements set_moving_bounds(); `changes` is the result.
class Bounds {
 public:
  Bounds(absl::FunctionRef<MovingBox(ChildRef)> leaf_box, WideTree& tree)
      : leaf_box_(leaf_box), tree_(tree) {
    changes.resize(tree.nodes.size(), {});
    const MovingBox all = set(tree.root);
    tree.reach = round_outwards(both(all.at_open, all.at_close)).reach();
  }

  NodeChanges changes;

 private:
  /// Sets the bounds in the subtree `ref`, and returns those of its root.
  MovingBox set(ChildRef ref) {
    if (ref.is_leaf()) {
      return leaf_box_(ref);
    }
    MovingBox all;
    for (std::size_t i = 0; i < WideNode::kChildren; ++i) {
      // No reference to the node is kept during the recursion; its index is enough.
      const bool used = tree_.nodes[ref.node_index()].bounds[0][i] != FloatBox::kInf;
      if (used) {
        const MovingBox child = set(tree_.nodes[ref.node_index()].child[i]);
        set_child(ref.node_index(), i, child);
        all = {both(all.at_open, child.at_open), both(all.at_close, child.at_close)};
      }
    }
    return all;
  }

  /// Sets the bounds of child `i` of the node, and their changes, from the box of the child.
  void set_child(std::uint32_t node, std::size_t i, const MovingBox& box) {
    for (int k = 0; k < 3; ++k) {
      const auto row = static_cast<std::size_t>(k);
      set_plane(node, row, i, box.at_open.lo[k], box.at_close.lo[k], -1);
      set_plane(node, row + 3, i, box.at_open.hi[k], box.at_close.hi[k], 1);
    }
  }

  /// Sets the bound in `row` of child `i`. `outwards` is -1 for a lower and 1 for an upper bound.
  void set_plane(std::uint32_t node, std::size_t row, std::size_t i, double open, double close,
                 double outwards) {
    const double margin = kLerpError * std::max(std::abs(open), std::abs(close)) + kTiny;
    const auto rounded = [outwards](double x) {
      return outwards < 0 ? round_down(x) : round_up(x);
    };
    const float from = rounded(open + outwards * margin);
    const float change = rounded(close + outwards * margin) - from;
    if (!std::isfinite(change)) {  // The movement is too large for a float: use an infinite bound.
      tree_.nodes[node].bounds[row][i] = outwards < 0 ? -FloatBox::kInf : FloatBox::kInf;
      return;
    }
    tree_.nodes[node].bounds[row][i] = from;
    changes[node][row][i] = change;
  }

  const absl::FunctionRef<MovingBox(ChildRef)> leaf_box_;
  WideTree& tree_;
};

}  // namespace

Box both(const Box& a, const Box& b) {
  Box box = a;
  box.add(b.lo);
  box.add(b.hi);
  return box;
}

Box middle(const MovingBox& box) {
  return {0.5 * (box.at_open.lo + box.at_close.lo), 0.5 * (box.at_open.hi + box.at_close.hi)};
}

NodeChanges set_moving_bounds(absl::FunctionRef<MovingBox(ChildRef leaf)> leaf_box,
                              WideTree& tree) {
  return tree.empty ? NodeChanges() : std::move(Bounds(leaf_box, tree).changes);
}

}  // namespace bandsaw
