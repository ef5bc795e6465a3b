#include "renderlib/accel/moving_tree.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Interpolating a bound in float is off by at most 5u of the larger end (README.md, "Moving
/// boxes").
constexpr double kLerpError = 8 * 0x1p-24;
constexpr double kTiny = 0x1p-120;

Box both(const Box& a, const Box& b) {
  Box box = a;
  box.add(b.lo);
  box.add(b.hi);
  return box;
}

/// Returns the box at the middle of the interval, by which the tree is built.
Box middle(const MovingBox& box) {
  return {0.5 * (box.at_open.lo + box.at_close.lo), 0.5 * (box.at_open.hi + box.at_close.hi)};
}

/// Sets the bounds of all nodes from those of the moving instances.
class Bounds {
 public:
  Bounds(const std::vector<MovingBox>& boxes, MovingTree& tree) : boxes_(boxes), tree_(tree) {
    tree.change.resize(tree.tree.nodes.size(), {});
    const MovingBox all = set(tree.tree.root);
    tree.tree.reach = round_outwards(both(all.at_open, all.at_close)).reach();
  }

 private:
  MovingBox set(ChildRef ref) {
    if (ref.is_leaf()) {
      return boxes_[ref.leaf_index()];
    }
    MovingBox all;
    for (std::size_t i = 0; i < WideNode::kChildren; ++i) {
      // The node is not referenced across the recursion, which needs only its index.
      const bool used = tree_.tree.nodes[ref.node_index()].bounds[0][i] != FloatBox::kInf;
      if (used) {
        const MovingBox child = set(tree_.tree.nodes[ref.node_index()].child[i]);
        set_child(ref.node_index(), i, child);
        all = {both(all.at_open, child.at_open), both(all.at_close, child.at_close)};
      }
    }
    return all;
  }

  void set_child(std::uint32_t node, std::size_t i, const MovingBox& box) {
    for (int k = 0; k < 3; ++k) {
      const auto row = static_cast<std::size_t>(k);
      set_plane(node, row, i, box.at_open.lo[k], box.at_close.lo[k], -1);
      set_plane(node, row + 3, i, box.at_open.hi[k], box.at_close.hi[k], 1);
    }
  }

  void set_plane(std::uint32_t node, std::size_t row, std::size_t i, double open, double close,
                 double outwards) {
    const double room = kLerpError * std::max(std::abs(open), std::abs(close)) + kTiny;
    const auto rounded = [outwards](double x) {
      return outwards < 0 ? round_down(x) : round_up(x);
    };
    const float from = rounded(open + outwards * room);
    tree_.tree.nodes[node].bounds[row][i] = from;
    tree_.change[node][row][i] = rounded(close + outwards * room) - from;
  }

  const std::vector<MovingBox>& boxes_;
  MovingTree& tree_;
};

bool same_linear_part(const Transform& a, const Transform& b) {
  Transform moved = b;
  for (std::size_t i = 0; i < 3; ++i) {
    moved.m[i][3] = a.m[i][3];
  }
  return a == moved;
}

/// Returns true if the frame and its parents only translate.
bool slides(const Geometry& geometry, FrameId id) {
  for (; id != kNoFrame; id = geometry.frames[index_of(id)].parent) {
    const std::vector<Key>& keys = geometry.frames[index_of(id)].keys;
    for (const Key& key : keys) {
      if (!same_linear_part(key.at, keys.front().at)) {
        return false;
      }
    }
  }
  return true;
}

}  // namespace

MovingTree build_moving_tree(const Geometry& geometry, const Prototypes& prototypes,
                             const Interval& interval, Pool* pool) {
  MovingTree result;
  result.interval = interval;
  TreeItems items;
  std::vector<MovingBox> boxes;
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance& instance = geometry.instances[i];
    const std::optional<Prototype> prototype =
        instance.frame == kNoFrame ? std::nullopt : prototypes.of(geometry, instance);
    if (!prototype) {
      continue;
    }
    const auto box = moving_bounds(geometry, instance, prototype->box(), interval);
    if (box && add_item(middle(*box), static_cast<std::uint32_t>(boxes.size()), LeafKind::kInstance,
                        items)) {
      boxes.push_back(*box);
      const Transform at_open = to_world_at(geometry, instance, interval.open);
      result.moving.push_back({*prototype, static_cast<std::uint32_t>(i + 1),
                               slides(geometry, instance.frame),
                               inverse(at_open).value_or(Transform{})});
    }
  }
  BANDSAW_CHECK(items.size() <= kMaxTreeItems, "scene/check_counts.h refuses more");
  const BinaryTree binary = build_binary_tree(std::move(items), pool);
  result.tree = collapse(binary, [&](const BinaryNode& leaf) {
    return ChildRef::leaf(LeafKind::kInstance, binary.items[leaf.first].index);
  });
  if (!result.tree.empty) {
    Bounds(boxes, result);
  }
  return result;
}

}  // namespace bandsaw
