#pragma once

// The tree of the whole scene: the loose shapes and the instances.

#include <cstdint>
#include <vector>

#include "renderlib/accel/mesh_tree.h"
#include "renderlib/accel/sphere_pack.h"
#include "renderlib/math/transform.h"

namespace bandsaw {

/// An instance that can be hit.
struct PlacedMesh {
  const MeshTree* mesh = nullptr;
  std::uint32_t instance = 0;  ///< as PrimitiveId has it
  bool identity = false;       ///< its space is the world's
  Transform to_object;
};

struct TopTree {
  WideTree tree;
  std::vector<FlatPack> flats;
  std::vector<SpherePack> spheres;
  std::vector<PlacedMesh> placed;

  std::size_t bytes() const {
    return tree.bytes() + flats.capacity() * sizeof(FlatPack) +
           spheres.capacity() * sizeof(SpherePack) + placed.capacity() * sizeof(PlacedMesh);
  }
};

/// `meshes`, one a mesh of `geometry`, MUST outlive the result and stay where they are.
TopTree build_top_tree(const Geometry& geometry, const std::vector<MeshTree>& meshes, Pool* pool);

}  // namespace bandsaw
