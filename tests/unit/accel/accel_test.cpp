// The smallest use of Accel, the renderer's BVH: a ray hits the nearer of two shapes.

#include "renderlib/accel/accel.h"

#include <gtest/gtest.h>

#include "renderlib/geometry/surface.h"

namespace bandsaw {
namespace {

TEST(Accel, FindsTheNearestOfASphereAndAQuad) {
  Geometry g;
  g.spheres.push_back({{0, 0, -5}, 1, MaterialId{0}});
  g.quads.push_back({{-1, -1, -2}, {2, 0, 0}, {0, 2, 0}, MaterialId{1}});
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Ray ray{{0, 0, 0}, {0, 0, -1}};
  const Hit hit = accel.closest(ray);
  ASSERT_TRUE(hit);
  EXPECT_EQ(hit.t, 2);
  EXPECT_EQ(hit.id, (PrimitiveId{0, 1}));  // the quad; PrimitiveId{0, 0} is the sphere
  const SurfacePoint p = surface_at(g, ray, hit);
  EXPECT_EQ(p.geometric_normal, (Vec3{0, 0, 1}));
  EXPECT_EQ(p.uv, (Vec2{0.5, 0.5}));
  const Hit behind = accel.closest(spawn_ray(p, {0, 0, -1}));
  EXPECT_NEAR(behind.t, 2, 1e-9);
  EXPECT_EQ(behind.id, (PrimitiveId{0, 0}));
  EXPECT_TRUE(accel.occluded({{0, 0, 0}, {0, 0, -1}, 2.5}));
  EXPECT_FALSE(accel.occluded({{0, 0, 0}, {0, 0, -1}, 2}));
}

}  // namespace
}  // namespace bandsaw
