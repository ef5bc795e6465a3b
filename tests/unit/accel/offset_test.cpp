// Tests the origins of rays that leave surfaces (geometry/surface.h). Such a ray does not hit its
// own surface again, and it does not skip a surface that is near. An id such as O1 in a test's name
// is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/sampling/sphere_light.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

// A ray that leaves a flat mesh does not hit this mesh again near its origin, even if the placement
// squashes, mirrors and moves the mesh.
TEST(Offset, O1_NoRayHitsTheMeshPlaneItLeaves) {
  Mesh mesh;
  for (int i = 0; i <= 8; ++i) {
    for (int j = 0; j <= 8; ++j) {
      mesh.positions.push_back({static_cast<float>(i - 4) * 0.1f, 0.03f * static_cast<float>(i),
                                static_cast<float>(j - 4) * 0.1f});
    }
  }
  for (std::uint32_t i = 0; i < 8; ++i) {
    for (std::uint32_t j = 0; j < 8; ++j) {
      const std::uint32_t a = i * 9 + j;
      mesh.triangles.push_back({a, a + 1, a + 10});
      mesh.triangles.push_back({a, a + 10, a + 9});
    }
  }
  const Transform placements[] = {
      translation({1e5, 3, -1e4}) * rotation({3, 1, 2}, 77),
      rotation({1, 0, 3}, 20) * scaling({1, 1e-3, 1}),
      translation({5, 6, 7}) * rotation({1, 1, 1}, 50) * scaling({-30, 40, 1e-2}),
      translation({1, 1, 1}) * scaling({1e-6, 2e-6, -1e-6}),
  };
  Pool pool(1);
  test::Random random(2);
  for (const Transform& placement : placements) {
    Geometry g;
    g.meshes.push_back(mesh);
    g.instances.push_back({MeshId{0}, {}, placement});
    const Accel accel = Accel::build(g, pool);
    for (int i = 0; i < 20000; ++i) {
      const Vec3 target =
          placement.point({random.uniform(-0.35, 0.35), 0.1, random.uniform(-0.35, 0.35)});
      const Vec3 origin = placement.point({0, 3, 0});
      const Ray ray = {origin, target - origin};
      const Hit hit = accel.closest(ray);
      ASSERT_TRUE(hit);
      const SurfacePoint p = surface_at(g, ray, hit);
      const Hit again = accel.closest(spawn_ray(p, test::random_direction(random)));
      // Positions are rounded to float, so the mesh is not exactly flat. A ray may hit it again,
      // but only at a distance that is large compared with the offset.
      ASSERT_TRUE(!again || again.t > 1e3 * p.offset) << again.t << " " << p.offset;
    }
  }
  test::report_hard_case("O1",
                         "80,000 bounces off squashed, mirrored and moved meshes: no ray hits the "
                         "mesh near its origin");
}

// A sphere nearly touches a plane. Rays that leave the plane below the sphere hit the sphere.
TEST(Offset, O2_NarrowGapsAreNotSkipped) {
  Pool pool(1);
  test::Random random(3);
  for (const double gap : {1e-4, 1e-6, 1e-9}) {
    for (const double offset : {0.0, 1.0}) {
      Geometry g;
      g.quads.push_back({{offset - 2, offset, offset - 2}, {0, 0, 4}, {4, 0, 0}, {}});
      g.spheres.push_back({{offset, offset + 1 + gap, offset}, 1, {}});
      const Accel accel = Accel::build(g, pool);
      for (int i = 0; i < 5000; ++i) {
        const double reach = 0.5 * std::sqrt(gap);
        const Vec3 on_plane = {offset + reach * random.uniform(-1, 1), offset,
                               offset + reach * random.uniform(-1, 1)};
        const Ray ray = {on_plane - Vec3{0, 1, 0}, {0, 1, 0}};
        const Hit hit = accel.closest(ray);
        ASSERT_EQ(hit.id, (PrimitiveId{0, 1}));
        const Ray up = spawn_ray(surface_at(g, ray, hit), {0, 1, 0});
        const Hit under = accel.closest(up);
        ASSERT_EQ(under.id, (PrimitiveId{0, 0}));
        ASSERT_NEAR(under.t / gap, 1,
                    0.3);  // the sphere's curvature changes the gap by up to a quarter
      }
    }
  }
  test::report_hard_case("O2",
                         "30,000 rays across gaps of 1e-4, 1e-6, 1e-9: every ray hits the sphere");
}

/// Returns a point of a surface that belongs to no instance. `size`: the largest absolute value in
/// the computation of the position, which determines its rounding error.
SurfacePoint surface(const Vec3& position, const Vec3& normal, double size) {
  SurfacePoint p;
  p.position = position;
  p.geometric_normal = normal;
  p.offset = surface_offset(position, size);
  p.away = p.geometric_normal * p.offset;
  return p;
}

TEST(Offset, O4_VisibleLightsAreNotSelfShadowed) {
  Pool pool(1);
  test::Random random(4);
  for (const double offset : {0.0, 1e4}) {
    const Vec3 at = {offset, -offset, offset};
    Geometry g;
    g.spheres.push_back({at + Vec3{0, 3, 0}, 0.7, {}});
    g.quads.push_back({at + Vec3{-1, 2, -1}, {0.5, 0.1, 0}, {-0.1, 0.5, 0.3}, {}});
    g.quads.push_back({at + Vec3{-50, 0, -50}, {0, 0, 100}, {100, 0, 0}, {}});
    const Accel accel = Accel::build(g, pool);
    for (int i = 0; i < 50000; ++i) {
      const Vec3 floor = at + Vec3{random.uniform(-9, 9), 0, random.uniform(-9, 9)};
      const Ray down = {floor + Vec3{0, 0.01, 0}, {0, -1, 0}};
      const SurfacePoint p = surface_at(g, down, accel.closest(down));
      const double u = random.uniform();
      const double v = random.uniform();
      const Quad& quad = g.quads[0];
      const Vec3 on_quad = quad.corner + u * quad.u + v * quad.v;
      const Vec3 normal = normalize(cross(quad.u, quad.v));
      const Ray to_quad = spawn_ray_to(p, surface(on_quad, normal, 1));
      // The sphere may occlude the quad; the quad never occludes itself.
      ASSERT_NE(accel.closest(to_quad).id, (PrimitiveId{0, 1}));
      const auto s = sample_sphere_light(g.spheres[0].center, 0.7, p.position, u, v);
      ASSERT_TRUE(s);
      const Ray to_sphere = spawn_ray_to(p, surface(s->position, s->normal, 0.7));
      ASSERT_NE(accel.closest(to_sphere).id, (PrimitiveId{0, 0}));
    }
  }
  test::report_hard_case("O4", "200,000 shadow rays: none is occluded by its own light");
}

// The occluder is at the height 0.5. A light above the occluder is blocked. A light on it or below
// it is not.
TEST(Offset, O3_ANearOccluderBlocksALightAtAnyDistance) {
  Geometry g;
  g.quads.push_back({{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, {}});
  g.quads.push_back({{-1, 0.5, -1}, {0, 0, 2}, {2, 0, 0}, {}});
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Ray down = {{0, 0.1, 0}, {0, -1, 0}};
  const SurfacePoint p = surface_at(g, down, accel.closest(down));
  EXPECT_TRUE(accel.occluded(spawn_ray_to(p, {0, 1000, 0}, 0)));
  EXPECT_FALSE(accel.occluded(spawn_ray_to(p, {0, 0.5, 0}, 1e-9)));
  EXPECT_FALSE(accel.occluded(spawn_ray_to(p, {0, 0.4, 0}, 0)));
}

}  // namespace
}  // namespace bandsaw
