// A hit on a mesh has a pointer to the corners of the hit triangle, which are stored in the BVH. So
// the corners need not be looked up in the mesh. The stored corners equal the mesh's, to the bit.

#include <gtest/gtest.h>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

/// Returns two instances of a mesh, the first with an identity placement, and a sphere and a quad
/// that are loose (in no instance).
Geometry mixed() {
  Geometry geometry;
  geometry.meshes = {test::icosphere(3)};
  geometry.instances = {
      {MeshId{0}, MaterialId{0}, {}},
      {MeshId{0}, MaterialId{0}, translation({2.5, 0.3, 0}) * scaling({1, 2, 1})}};
  geometry.spheres = {{{-2.5, 0, 0}, 1, MaterialId{0}}};
  geometry.quads = {{{-9, -9, -3}, {18, 0, 0}, {0, 18, 0}, MaterialId{0}}};
  return geometry;
}

TEST(Corners, EqualThoseOfTheMesh) {
  const Geometry geometry = mixed();
  Pool pool(1);
  const Accel accel = Accel::build(geometry, pool);
  test::Random random(3);
  int of_meshes = 0;
  int loose = 0;
  for (int i = 0; i < 2000; ++i) {
    const Ray ray{.origin = {random.uniform(-4, 4), random.uniform(-2, 2), 6},
                  .direction = {0.01, 0.02, -1}};
    Hit hit = accel.closest(ray);
    ASSERT_TRUE(hit);
    if (hit.id.instance == 0) {
      ASSERT_EQ(hit.corners, nullptr);
      ++loose;
      continue;
    }
    ++of_meshes;
    ASSERT_NE(hit.corners, nullptr);
    const Mesh& mesh = geometry.meshes[0];
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t k = 0; k < 3; ++k) {
        ASSERT_EQ(hit.corners[(3 * c + k) * kCornerStride],
                  mesh.positions[mesh.triangles[hit.id.primitive][c]][k]);
      }
    }
    const SurfacePoint from_corners = surface_at(geometry, ray, hit);
    hit.corners = nullptr;
    const SurfacePoint looked_up = surface_at(geometry, ray, hit);
    ASSERT_EQ(from_corners.position, looked_up.position);
    ASSERT_EQ(from_corners.geometric_normal, looked_up.geometric_normal);
    ASSERT_EQ(from_corners.offset, looked_up.offset);
  }
  EXPECT_GT(of_meshes, 500);
  EXPECT_GT(loose, 500);
}

}  // namespace
}  // namespace bandsaw
