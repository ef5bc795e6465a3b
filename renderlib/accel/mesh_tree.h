#pragma once

// BVH of one mesh, in the mesh's own space.

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

/// Builds the tree. Omits triangles with a corner that is not finite or does not exist, and
/// triangles with two equal corners, which cover nothing that a neighbour does not cover. Triangles
/// of three different collinear points are kept: they close T-junctions. (Scene::build has removed
/// them, so this applies to geometry that is traced directly.) If `pool` is null, the build runs on
/// this thread.
MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool);

}  // namespace bandsaw
