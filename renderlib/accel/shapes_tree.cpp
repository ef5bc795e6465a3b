// A BVH is built from items, which are boxes with a number. ShapeItems makes an item for each
// sphere, triangle and disk, and for each half of a quad. Each leaf is a pack: up to eight shapes
// of one kind, stored side by side as floats.

#include "renderlib/accel/shapes_tree.h"

#include <array>

#include "absl/types/span.h"
#include "renderlib/accel/capacity.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"
#include "renderlib/geometry/disk.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/math/float3.h"

namespace bandsaw {
namespace {

/// Returns the two triangles that the intersection test of a quad uses (geometry/intersect.h).
std::array<Triangle, 2> halves(const Quad& quad) {
  const Vec3 along_u = quad.corner + quad.u;
  const Vec3 opposite = along_u + quad.v;
  return {Triangle{quad.corner, along_u, opposite, {}},
          Triangle{quad.corner, opposite, quad.corner + quad.v, {}}};
}

/// Returns a sphere around the disk. Every ray that hits the disk also hits this sphere.
Sphere around(const Disk& disk) { return {disk.center, disk.radius, disk.material}; }

}  // namespace

bool add_item(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items) {
  const FloatBox rounded_box = round_outwards(box);
  if (!rounded_box.can_be_hit()) {
    return false;
  }
  items.push_back({rounded_box, index, kind});
  return true;
}

void ShapeItems::add(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items) {
  if (add_item(box, index, kind, items)) {
    tree_.box.add(box.lo);
    tree_.box.add(box.hi);
  }
}

void ShapeItems::add_all(TreeItems& items) {
  std::uint32_t index = 0;
  for (const Sphere& sphere : shapes_.spheres) {
    add(bounds(sphere), index++, LeafKind::kSpheres, items);
  }
  for (const Quad& quad : shapes_.quads) {
    const auto [first, second] = halves(quad);
    add(bounds(first), 2 * index, LeafKind::kFlats, items);
    add(bounds(second), 2 * index + 1, LeafKind::kFlats, items);
    ++index;
  }
  for (const Triangle& triangle : shapes_.triangles) {
    add(bounds(triangle), 2 * index++, LeafKind::kFlats, items);
  }
  for (std::uint32_t i = 0; i < shapes_.disks.size(); ++i) {
    add(bounds(shapes_.disks[i]), i, LeafKind::kDisks, items);
  }
}

Triangle ShapeItems::flat(std::uint32_t item) const {
  const auto [kind, index] = shape_ref(shapes_, item / 2);
  return kind == ShapeKind::kQuad ? halves(shapes_.quads[index])[item % 2]
                                  : shapes_.triangles[index];
}

ChildRef ShapeItems::make_leaf(const BinaryTree& tree, const BinaryNode& leaf) {
  const absl::Span<const ItemRef> items(&tree.items[leaf.first], leaf.count);
  const LeafKind kind = items.front().kind;
  const auto last = [kind](const auto& packs) {
    return ChildRef::leaf(kind, static_cast<std::uint32_t>(packs.size() - 1));
  };
  if (kind == LeafKind::kSpheres) {
    SpherePack& pack = tree_.spheres.emplace_back();
    for (const ItemRef& item : items) {
      pack.add(shapes_.spheres[item.index], item.index);
    }
    return last(tree_.spheres);
  }
  if (kind == LeafKind::kDisks) {
    SpherePack& pack = tree_.disks.emplace_back();
    for (const ItemRef& item : items) {
      pack.add(around(shapes_.disks[item.index]), item.index);
    }
    return last(tree_.disks);
  }
  FlatPacker packer(tree_.flats.emplace_back());
  for (const ItemRef& item : items) {
    const Triangle t = flat(item.index);
    packer.add_rounded({float3(t.a), float3(t.b), float3(t.c)}, item.index / 2);
  }
  return last(tree_.flats);
}

ShapesTree build_shapes_tree(const Shapes& shapes, Pool* pool) {
  ShapesTree result;
  result.shapes = &shapes;
  ShapeItems shape_items(shapes, result);
  TreeItems items;
  shape_items.add_all(items);
  BANDSAW_CHECK(items.size() <= kMaxTreeItems, "scene/check_counts.h refuses more items");
  const BinaryTree binary = build_binary_tree(std::move(items), pool);
  result.tree =
      collapse(binary, [&](const BinaryNode& leaf) { return shape_items.make_leaf(binary, leaf); });
  return result;
}

}  // namespace bandsaw
