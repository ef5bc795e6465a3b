#pragma once

// BVH of one mesh, in the mesh's own space.

#include "renderlib/accel/flat_pack.h"
#include "renderlib/accel/moving_nodes.h"
#include "renderlib/accel/wide_tree.h"
#include "renderlib/base/pool.h"
#include "renderlib/geometry/box.h"
#include "renderlib/geometry/deforming_mesh.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

struct MeshTree {
  WideTree tree;
  HugeVector<FlatPack> packs;
  Box box;  ///< at all times
  /// For a mesh that deforms: changes of the nodes' bounds, and the corners of the packs at the end
  /// of the shutter interval; `tree` and `packs` are those at its beginning. Otherwise empty.
  NodeChanges changes;
  HugeVector<FlatPack::Corners> corners_at_close;

  bool deforms() const { return !corners_at_close.empty(); }
  std::size_t bytes() const {
    return tree.bytes() + packs.capacity() * sizeof(FlatPack) +
           changes.capacity() * sizeof(NodeChanges::value_type) +
           corners_at_close.capacity() * sizeof(FlatPack::Corners);
  }
};

/// Returns the pack number `pack` with its corners at the time `now`. The mesh MUST deform.
FlatPack pack_at(const MeshTree& mesh, std::uint32_t pack, const ShutterTime& now);

/// Builds the tree. Omits triangles with a corner that is not finite or does not exist, and
/// triangles with two corners that are equal (at both ends, if the mesh deforms), which cover
/// nothing that a neighbour does not cover. Triangles of three different collinear points are kept:
/// they close T-junctions. (Scene::build has removed them, so this applies to geometry that is
/// traced directly.) If `pool` is null, the build runs on this thread.
MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool);

}  // namespace bandsaw
