// Builds the tree of the instances that move, from their boxes at the middle of the shutter
// interval. Then the nodes of the tree get bounds that move.

#include "renderlib/accel/moving_tree.h"

#include <utility>

#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"
#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Returns true if the transforms differ at most in their translations.
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

MovingTree build_moving_tree(const Geometry& geometry, const Prototypes& prototypes, Pool* pool) {
  MovingTree result;
  TreeItems items;
  std::vector<MovingBox> boxes;
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance& instance = geometry.instances[i];
    const std::optional<Prototype> prototype =
        instance.frame == kNoFrame ? std::nullopt : prototypes.of(instance);
    if (!prototype) {
      continue;
    }
    const auto box = moving_bounds(geometry, instance, prototype->box());
    if (box && add_item(middle(*box), static_cast<std::uint32_t>(boxes.size()), LeafKind::kInstance,
                        items)) {
      boxes.push_back(*box);
      const Transform at_open = to_world_at(geometry, instance, geometry.shutter.open);
      // The number of an instance in hits is its index + 1 (PrimitiveId).
      result.moving.push_back({*prototype, static_cast<std::uint32_t>(i + 1),
                               slides(geometry, instance.frame),
                               inverse(at_open).value_or(Transform{})});
    }
  }
  BANDSAW_CHECK(items.size() <= kMaxTreeItems, "scene/check_counts.h refuses more items");
  const BinaryTree binary = build_binary_tree(std::move(items), pool);
  result.tree = collapse(binary, [&](const BinaryNode& leaf) {
    return ChildRef::leaf(LeafKind::kInstance, binary.items[leaf.first].index);
  });
  const auto box_of = [&](ChildRef leaf) { return boxes[leaf.leaf_index()]; };
  // Sets the bounds of the nodes to those at the beginning of the interval. `changes` holds how far
  // each bound moves until the end of the interval.
  result.changes = set_moving_bounds(box_of, result.tree);
  return result;
}

}  // namespace bandsaw
