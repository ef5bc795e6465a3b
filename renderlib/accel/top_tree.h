#pragma once

// The tree of the whole scene: the loose shapes and the instances.

#include <cstdint>
#include <optional>
#include <vector>

#include "renderlib/accel/mesh_tree.h"
#include "renderlib/accel/shapes_tree.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// The tree of a mesh or of a group.
struct Prototype {
  const MeshTree* mesh = nullptr;  ///< null: a group
  const ShapesTree* group = nullptr;
  const Shapes* shapes = nullptr;  ///< the group's

  const Box& box() const { return mesh != nullptr ? mesh->box : group->box; }
  bool empty() const { return mesh != nullptr ? mesh->tree.empty : group->tree.empty; }
};

/// Trees of everything that is placed. They and the geometry MUST outlive what is built of them and
/// stay where they are.
struct Prototypes {
  std::vector<MeshTree> meshes;    ///< one a mesh of the geometry
  std::vector<ShapesTree> groups;  ///< one a group

  /// Nothing: the instance places nothing that can be hit.
  std::optional<Prototype> of(const Geometry& geometry, const Instance& instance) const;
};

/// An instance that can be hit.
struct Placed {
  Prototype prototype;
  std::uint32_t instance = 0;  ///< as PrimitiveId has it
  bool identity = false;       ///< its space is the world's
  Transform to_object;
};

struct TopTree : ShapesTree {
  std::vector<Placed> placed;

  std::size_t bytes() const { return ShapesTree::bytes() + placed.capacity() * sizeof(Placed); }
};

/// The loose shapes and the instances that do not move.
TopTree build_top_tree(const Geometry& geometry, const Prototypes& prototypes, Pool* pool);

}  // namespace bandsaw
