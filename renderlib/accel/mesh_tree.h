#pragma once

// The tree of one mesh, in the mesh's own space.

#include "renderlib/accel/flat_pack.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/pool.h"
#include "renderlib/geometry/box.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct MeshTree {
  WideTree tree;
  HugeVector<FlatPack> packs;
  Box box;

  std::size_t bytes() const { return tree.bytes() + packs.capacity() * sizeof(FlatPack); }
};

/// Left out are triangles with a corner that is not finite or not there, and those with two equal
/// corners: they span nothing that a neighbour does not cover. (Triangles of three different points
/// on a line stay: they close T-junctions.) `pool` null: on this thread.
MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool);

}  // namespace bandsaw
