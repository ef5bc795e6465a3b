// The list of all primitives that have certain materials, compared with a search of all primitives.

#include "renderlib/geometry/primitive_list.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "renderlib/geometry/placement.h"

namespace bandsaw {
namespace {

/// Returns loose spheres, two groups and instances of the groups, with materials 0 to 3. The shapes
/// of an instance with kOwnMaterial keep the materials of the group.
Geometry geometry() {
  Geometry out;
  for (std::uint32_t material : {0, 2, 1, 2}) {
    out.spheres.push_back({{0, 0, 0}, 1, MaterialId{material}});
  }
  Shapes mixed;
  mixed.quads.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId{2}});
  mixed.disks.push_back({.center = {}, .material = MaterialId{3}});
  mixed.disks.push_back({.center = {}, .material = MaterialId{2}});
  Shapes plain;
  plain.triangles.push_back({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, MaterialId{3}});
  out.groups = {mixed, plain};
  const auto place = [&](std::uint32_t group, MaterialId material) {
    out.instances.push_back({.material = material, .to_world = {}, .group = GroupId{group}});
  };
  place(1, kOwnMaterial);
  place(0, kOwnMaterial);
  place(0, MaterialId{1});
  place(0, kOwnMaterial);
  place(1, MaterialId{2});
  return out;
}

TEST(PrimitiveList, HasThePrimitivesOfTheMaterialsInOrder) {
  const Geometry all = geometry();
  // Each bit says whether the primitives of one material are wanted.
  for (unsigned bits = 0; bits < 16; ++bits) {
    std::vector<bool> wanted;
    for (unsigned material = 0; material < 4; ++material) {
      wanted.push_back((bits >> material & 1) != 0);
    }
    // Pairs of instance and primitive. The loose shapes, which are in no group, count as instance
    // 0. So element i of `instances` counts as instance i + 1.
    std::vector<std::pair<std::uint32_t, std::uint32_t>> expected;
    for (std::uint32_t i = 0; i < all.spheres.size(); ++i) {
      if (wanted[index_of(all.spheres[i].material)]) {
        expected.emplace_back(0, i);
      }
    }
    for (std::uint32_t i = 0; i < all.instances.size(); ++i) {
      for (std::uint32_t k = 0; k < primitives_of(all, all.instances[i]); ++k) {
        if (wanted[index_of(material_of(all, all.instances[i], k))]) {
          expected.emplace_back(i + 1, k);
        }
      }
    }
    const PrimitiveList list(all, wanted);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> found;
    for (std::uint64_t i = 0; i < list.size(); ++i) {
      found.emplace_back(list[i].instance, list[i].primitive);
    }
    EXPECT_EQ(found, expected) << bits;
  }
}

}  // namespace
}  // namespace bandsaw
