#include "renderlib/accel/top_tree.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "absl/types/span.h"
#include "renderlib/accel/collapse.h"
#include "renderlib/base/check.h"
#include "renderlib/geometry/intersect.h"

namespace bandsaw {
namespace {

/// The world box of a placed box, with room for the rounding of a ray that goes there and back.
Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object) {
  double grown = 0;
  double shrunk = 0;
  double moved = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      grown = std::max(grown, std::abs(to_world.m[i][j]));
      shrunk = std::max(shrunk, std::abs(to_object.m[i][j]));
    }
    moved = std::max(moved, std::abs(to_world.m[i][3]));
  }
  const double largest = std::max(max_abs(box.lo), max_abs(box.hi));
  const double slack = 0x1p-46 * (grown * shrunk) * (3 * grown * largest + moved);
  const Vec3 room = {slack, slack, slack};
  Box result;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = to_world.point({(corner & 1) != 0 ? box.hi.x : box.lo.x,
                                   (corner & 2) != 0 ? box.hi.y : box.lo.y,
                                   (corner & 4) != 0 ? box.hi.z : box.lo.z});
    result.add(p - room);
    result.add(p + room);
  }
  return result;
}

std::array<float, 3> rounded(const Vec3& p) {
  return {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)};
}

/// The triangles that the test of a quad consists of (geometry/intersect.h).
std::array<Triangle, 2> halves(const Quad& quad) {
  const Vec3 along_u = quad.corner + quad.u;
  const Vec3 opposite = along_u + quad.v;
  return {Triangle{quad.corner, along_u, opposite, {}},
          Triangle{quad.corner, opposite, quad.corner + quad.v, {}}};
}

/// The tree's items: spheres under their number, the triangles of loose flats under twice their
/// number (geometry/shapes.h), plus one for the second half of a quad, and instances under their
/// place in TopTree::placed.
class TopBuilder {
 public:
  TopBuilder(const Geometry& geometry, TopTree& top) : geometry_(geometry), top_(top) {}

  void add_shapes();
  void add_instances(const std::vector<MeshTree>& meshes);
  void build(Pool* pool);

 private:
  void add(const Box& box, std::uint32_t index, LeafKind kind);
  ChildRef make_leaf(const BinaryTree& tree, const BinaryNode& leaf);
  Triangle flat(std::uint32_t item) const;

  const Geometry& geometry_;
  TopTree& top_;
  std::vector<TreeItem> items_;
};

void TopBuilder::add(const Box& box, std::uint32_t index, LeafKind kind) {
  const FloatBox rounded_box = round_outwards(box);
  if (rounded_box.can_be_hit()) {
    items_.push_back({rounded_box, index, kind});
  }
}

void TopBuilder::add_shapes() {
  std::uint32_t index = 0;
  for (const Sphere& sphere : geometry_.spheres) {
    add(bounds(sphere), index++, LeafKind::kSpheres);
  }
  for (const Quad& quad : geometry_.quads) {
    const auto [first, second] = halves(quad);
    add(bounds(first), 2 * index, LeafKind::kFlats);
    add(bounds(second), 2 * index + 1, LeafKind::kFlats);
    ++index;
  }
  for (const Triangle& triangle : geometry_.triangles) {
    add(bounds(triangle), 2 * index++, LeafKind::kFlats);
  }
}

void TopBuilder::add_instances(const std::vector<MeshTree>& meshes) {
  for (std::size_t i = 0; i < geometry_.instances.size(); ++i) {
    const Instance& instance = geometry_.instances[i];
    const std::size_t mesh = index_of(instance.mesh);
    const std::optional<Transform> to_object = inverse(instance.to_world);
    if (mesh < meshes.size() && to_object && !meshes[mesh].tree.empty) {
      add(placed_bounds(meshes[mesh].box, instance.to_world, *to_object),
          static_cast<std::uint32_t>(top_.placed.size()), LeafKind::kInstance);
      top_.placed.push_back({&meshes[mesh], static_cast<std::uint32_t>(i + 1),
                             instance.to_world == Transform{}, *to_object});
    }
  }
}

Triangle TopBuilder::flat(std::uint32_t item) const {
  const std::size_t first_quad = geometry_.spheres.size();
  const std::size_t first_triangle = first_quad + geometry_.quads.size();
  const std::size_t index = item / 2;
  return index < first_triangle ? halves(geometry_.quads[index - first_quad])[item % 2]
                                : geometry_.triangles[index - first_triangle];
}

ChildRef TopBuilder::make_leaf(const BinaryTree& tree, const BinaryNode& leaf) {
  const absl::Span<const TreeItem> items(&tree.items[leaf.first], leaf.count);
  const LeafKind kind = items.front().kind;
  if (kind == LeafKind::kInstance) {
    return ChildRef::leaf(kind, items.front().index);
  }
  if (kind == LeafKind::kSpheres) {
    SpherePack& pack = top_.spheres.emplace_back();
    for (const TreeItem& item : items) {
      pack.add(geometry_.spheres[item.index], item.index);
    }
    return ChildRef::leaf(kind, static_cast<std::uint32_t>(top_.spheres.size() - 1));
  }
  FlatPacker packer(top_.flats.emplace_back());
  for (const TreeItem& item : items) {
    const Triangle t = flat(item.index);
    packer.add_rounded({rounded(t.a), rounded(t.b), rounded(t.c)}, item.index / 2);
  }
  return ChildRef::leaf(kind, static_cast<std::uint32_t>(top_.flats.size() - 1));
}

void TopBuilder::build(Pool* pool) {
  BANDSAW_CHECK(items_.size() < ChildRef::kMaxLeaves, "the package's limits are lower");
  const BinaryTree binary = build_binary_tree(std::move(items_), pool);
  top_.tree = collapse(binary, [&](const BinaryNode& leaf) { return make_leaf(binary, leaf); });
}

}  // namespace

TopTree build_top_tree(const Geometry& geometry, const std::vector<MeshTree>& meshes, Pool* pool) {
  TopTree top;
  TopBuilder builder(geometry, top);
  builder.add_shapes();
  builder.add_instances(meshes);
  builder.build(pool);
  return top;
}

}  // namespace bandsaw
