#pragma once

// Top-level BVH of the scene. It contains the loose shapes (those of no mesh and no group) and the
// static instances of meshes and groups. An instance is static if it lies in no frame, a coordinate
// system that moves. The tree of moving_tree.h contains the other instances.

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "renderlib/accel/mesh_tree.h"
#include "renderlib/accel/shapes_tree.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// The BVH of a mesh or of a group, which instances place. Exactly one of the pointers is not
/// null.
struct Prototype {
  const MeshTree* mesh = nullptr;       ///< a mesh that does not deform
  const MeshTree* deforming = nullptr;  ///< a mesh that deforms during the shutter interval
  const ShapesTree* group = nullptr;

  const Box& box() const { return group != nullptr ? group->box : any_mesh().box; }
  bool empty() const { return group != nullptr ? group->tree.empty : any_mesh().tree.empty; }

 private:
  const MeshTree& any_mesh() const { return mesh != nullptr ? *mesh : *deforming; }
};

/// BVHs of all meshes and groups. They and the geometry MUST outlive everything built from them,
/// and MUST NOT be moved in memory.
struct Prototypes {
  /// One for each mesh of the geometry. If scenes share a mesh, they share its BVH as well.
  std::vector<std::shared_ptr<const MeshTree>> meshes;
  std::vector<ShapesTree> groups;  ///< one for each group

  /// Returns the BVH of an instance; std::nullopt if the instance contains nothing that can be hit.
  std::optional<Prototype> of(const Instance& instance) const;
};

/// A static instance that can be hit.
struct Placed {
  Prototype prototype;
  std::uint32_t instance = 0;  ///< as in PrimitiveId
  bool identity = false;       ///< true if `to_object` is the identity
  Transform to_object;
};

struct TopTree : ShapesTree {
  std::vector<Placed> placed;  ///< by the index of the leaf

  std::size_t bytes() const { return ShapesTree::bytes() + placed.capacity() * sizeof(Placed); }
};

/// Builds the tree over the loose shapes and the static instances.
TopTree build_top_tree(const Geometry& geometry, const Prototypes& prototypes, Pool* pool);

}  // namespace bandsaw
