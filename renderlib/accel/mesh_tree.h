#pragma once

// BVH of one mesh, in the mesh's own space. Instances of the mesh share it (top_tree.h, trace.h).

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
  HugeVector<FlatPack> packs;  ///< the leaves
  Box box;                     ///< contains the mesh at all times of the shutter interval
  /// `changes` and `corners_at_close` are empty unless the mesh deforms during the shutter
  /// interval. `changes` holds how far the bounds of the nodes move from the beginning to the end
  /// of the interval, and `corners_at_close` holds the corners of the packs at the end. `tree` and
  /// `packs` have the bounds and the corners at the beginning.
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

/// Builds the tree. Omits triangles with a corner that is not finite or does not exist. Omits also
/// triangles with two equal corners (equal at both ends, if the mesh deforms), because their
/// neighbours cover the same points. Triangles of three different collinear points are kept,
/// because they close T-junctions. If `pool` is null, the build runs on this thread. (Scene::build
/// removes triangles that cannot be hit. So these rules matter for geometry that is traced
/// without Scene::build.)
MeshTree build_mesh_tree(const Mesh& mesh, Pool* pool);

}  // namespace bandsaw
