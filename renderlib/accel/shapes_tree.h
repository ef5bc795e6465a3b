#pragma once

// The tree over loose shapes in one space: of a group, or of the world together with its instances
// (top_tree.h).

#include <cstdint>
#include <vector>

#include "renderlib/accel/binary_tree.h"
#include "renderlib/accel/flat_pack.h"
#include "renderlib/accel/sphere_pack.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct ShapesTree {
  WideTree tree;
  std::vector<FlatPack> flats;
  std::vector<SpherePack> spheres;
  std::vector<SpherePack> disks;  ///< the spheres around them
  Box box;                        ///< of all shapes

  std::size_t bytes() const {
    return tree.bytes() + flats.capacity() * sizeof(FlatPack) +
           (spheres.capacity() + disks.capacity()) * sizeof(SpherePack);
  }
};

/// The items of a tree over shapes, and its leaves. Spheres and disks go under their number among
/// their kind, the triangles of flats under twice their number as primitives (geometry/shapes.h),
/// plus one for the second half of a quad.
class ShapeItems {
 public:
  /// Both MUST outlive this.
  ShapeItems(const Shapes& shapes, ShapesTree& tree) : shapes_(shapes), tree_(tree) {}

  void add_all(TreeItems& items);
  /// Lays out a leaf of shapes, which are of one kind.
  ChildRef make_leaf(const BinaryTree& tree, const BinaryNode& leaf);

 private:
  void add(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items);
  Triangle flat(std::uint32_t item) const;

  const Shapes& shapes_;
  ShapesTree& tree_;
};

/// Appends an item; false: its box cannot be hit, it is left out.
bool add_item(const Box& box, std::uint32_t index, LeafKind kind, TreeItems& items);

ShapesTree build_shapes_tree(const Shapes& shapes, Pool* pool);

}  // namespace bandsaw
