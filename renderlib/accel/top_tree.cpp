// Builds the tree over the loose shapes (those of no mesh and no group) and the static instances of
// a scene. A BVH is built from items, which are boxes with an index. A leaf is one instance, or a
// pack of up to eight loose shapes of one kind.

#include "renderlib/accel/top_tree.h"

#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"
#include "renderlib/geometry/moving_bounds.h"

namespace bandsaw {
namespace {

/// Appends an item and an element of top.placed for each instance that lies in no moving frame and
/// can be hit. The index of the item is that of the element.
void add_instances(const Geometry& geometry, const Prototypes& prototypes, TopTree& top,
                   TreeItems& items) {
  for (std::size_t i = 0; i < geometry.instances.size(); ++i) {
    const Instance& instance = geometry.instances[i];
    const std::optional<Transform> to_object = inverse(instance.to_world);
    const std::optional<Prototype> prototype = prototypes.of(instance);
    if (instance.frame == kNoFrame && to_object && prototype &&
        add_item(placed_bounds(prototype->box(), instance.to_world, *to_object),
                 static_cast<std::uint32_t>(top.placed.size()), LeafKind::kInstance, items)) {
      // The number of an instance in hits is its index + 1 (PrimitiveId).
      top.placed.push_back({*prototype, static_cast<std::uint32_t>(i + 1),
                            instance.to_world == Transform{}, *to_object});
    }
  }
}

}  // namespace

std::optional<Prototype> Prototypes::of(const Instance& instance) const {
  Prototype prototype;
  if (instance.group != kNoGroup && index_of(instance.group) < groups.size()) {
    prototype.group = &groups[index_of(instance.group)];
  } else if (instance.group == kNoGroup && index_of(instance.mesh) < meshes.size()) {
    const MeshTree& mesh = *meshes[index_of(instance.mesh)];
    (mesh.deforms() ? prototype.deforming : prototype.mesh) = &mesh;
  } else {
    return std::nullopt;
  }
  return prototype.empty() ? std::nullopt : std::optional(prototype);
}

TopTree build_top_tree(const Geometry& geometry, const Prototypes& prototypes, Pool* pool) {
  TopTree top;
  ShapeItems shape_items(geometry, top);
  TreeItems items;
  shape_items.add_all(items);
  add_instances(geometry, prototypes, top, items);
  BANDSAW_CHECK(items.size() <= kMaxTreeItems, "scene/check_counts.h refuses more items");
  const BinaryTree binary = build_binary_tree(std::move(items), pool);
  top.tree = collapse(binary, [&](const BinaryNode& leaf) {
    const ItemRef& first = binary.items[leaf.first];
    return first.kind == LeafKind::kInstance ? ChildRef::leaf(first.kind, first.index)
                                             : shape_items.make_leaf(binary, leaf);
  });
  return top;
}

}  // namespace bandsaw
