#pragma once

// BVH over loose shapes, i.e. spheres, quads, triangles and disks that belong to no mesh. The BVH
// of a group contains the group's shapes, in the group's own space. The BVH of the world contains
// the world's shapes and, in addition, instances (top_tree.h).

#include <cstdint>
#include <vector>

#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/flat_pack.h"
#include "renderlib/accel/sphere_pack.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct ShapesTree {
  WideTree tree;
  std::vector<FlatPack> flats;  ///< leaves of triangles and quads
  std::vector<SpherePack> spheres;
  std::vector<SpherePack> disks;  ///< bounding spheres of the disks
  Box box;                        ///< bounds of all shapes
  const Shapes* shapes = nullptr;

  std::size_t bytes() const {
    return tree.bytes() + flats.capacity() * sizeof(FlatPack) +
           (spheres.capacity() + disks.capacity()) * sizeof(SpherePack);
  }
};

/// Makes the items and leaves of a tree over shapes. The item index of a sphere or disk is its
/// index within its kind. The item index of a triangle or of half a quad is twice its primitive
/// number (geometry/shapes.h), plus one for the second half of a quad.
class ShapeItems {
 public:
  /// `shapes` and `tree` MUST outlive this object.
  ShapeItems(const Shapes& shapes, ShapesTree& tree) : shapes_(shapes), tree_(tree) {}

  /// Appends an item for each shape that can be hit (two for a quad), and enlarges the tree's box
  /// by the boxes of these shapes.
  void add_all(TreeItems& items);
  /// Stores a leaf of shapes, which are all of one kind, as a pack and returns the reference to it.
  ChildRef make_leaf(const BinaryTree& tree, const BinaryNode& leaf);

 private:
  void add(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items);
  /// Returns the triangle, or half of a quad, with this item index.
  Triangle flat(std::uint32_t item) const;

  const Shapes& shapes_;
  ShapesTree& tree_;
};

/// Appends an item to `items`. If `box` cannot be hit, appends nothing and returns false.
bool add_item(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items);

/// Builds the tree of a group. `shapes` MUST outlive the result and not be moved in memory. If
/// `pool` is null, the build runs on this thread.
ShapesTree build_shapes_tree(const Shapes& shapes, Pool* pool);

}  // namespace bandsaw
