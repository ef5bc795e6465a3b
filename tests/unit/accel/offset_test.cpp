// Where rays leave a surface (geometry/surface.h): no hit of the surface they leave, no near thing
// passed over.

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/sampling/sphere_light.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

/// A flat square of 8 x 8 cells of edge `size`, turned, its middle at `at`: as a mesh, as quads, or
/// as triangles.
Geometry flat_patch(double size, const Vec3& at, int kind) {
  const Transform turn = rotation({1, 2, 3}, 33);
  const auto point = [&](int i, int j) {
    return at + turn.point({(i - 4) * size, 0, (j - 4) * size});
  };
  Geometry g;
  Mesh mesh;
  for (int i = 0; i < 8; ++i) {
    for (int j = 0; j < 8; ++j) {
      const Vec3 a = point(i, j);
      const Vec3 b = point(i + 1, j);
      const Vec3 c = point(i + 1, j + 1);
      const Vec3 d = point(i, j + 1);
      if (kind == 0) {
        g.triangles.push_back({a, c, b, {}});
        g.triangles.push_back({a, d, c, {}});
      } else {
        g.quads.push_back({a, d - a, b - a, {}});
      }
    }
  }
  return g;
}

// The rays that leave a plane hit no neighbour in the plane, whatever the scales.
TEST(Offset, NoRayHitsThePlaneItLeaves) {
  const std::pair<double, double> rows[] = {{1, 0},    {1, 1e3}, {1, 1e5},    {1, 1e6},
                                            {1e-3, 1}, {1e6, 0}, {1e-6, 1e-6}};
  Pool pool(1);
  test::Random random(1);
  for (const auto& [size, offset] : rows) {
    for (const int kind : {0, 1}) {
      const Vec3 at = offset * normalize(Vec3{1, 2, -3});
      const Geometry g = flat_patch(size, at, kind);
      const Accel accel = Accel::build(g, pool);
      const Vec3 up = rotation({1, 2, 3}, 33).point({0, 1, 0});
      int bounces = 0;
      for (int i = 0; i < 20000; ++i) {
        const Vec3 origin = at + 3 * size * (up + 0.9 * test::random_point(random));
        const Ray ray = {origin, -normalize(up + 0.5 * test::random_point(random))};
        const Hit hit = accel.closest(ray);
        if (!hit) {
          continue;
        }
        const SurfacePoint p = surface_at(g, ray, hit);
        ASSERT_GT(std::abs(dot(p.geometric_normal, up)), 0.99);
        ++bounces;
        const Vec3 d = test::random_direction(random);
        const Vec3 flat = normalize(d - (1 - 1e-4 * random.uniform()) * dot(d, up) * up);
        ASSERT_FALSE(accel.closest(leave(p, d))) << size << " " << offset;
        ASSERT_FALSE(accel.closest(leave(p, flat))) << size << " " << offset;
      }
      ASSERT_GT(bounces, 5000);
    }
  }
}

// The same on a mesh whose placement squashes, mirrors and moves it.
TEST(Offset, NoRayHitsTheMeshPlaneItLeaves) {
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
      const Hit again = accel.closest(leave(p, test::random_direction(random)));
      // Positions are rounded to float, so the mesh is not quite flat: what is hit must be a little
      // way off.
      ASSERT_TRUE(!again || again.t > 1e3 * p.offset) << again.t << " " << p.offset;
    }
  }
}

// A sphere that all but touches a plane: rays from the plane under it see it.
TEST(Offset, NarrowGapsAreNotPassedOver) {
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
        const Ray up = leave(surface_at(g, ray, hit), {0, 1, 0});
        const Hit under = accel.closest(up);
        ASSERT_EQ(under.id, (PrimitiveId{0, 0}));
        ASSERT_NEAR(under.t / gap, 1, 0.3);  // the sphere curves away by up to a quarter
      }
    }
  }
}

TEST(Offset, NothingStandsBetweenAPointAndALightItSees) {
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
      const Ray to_quad = toward(p, on_quad, surface_offset(on_quad, 1), normal);
      // The sphere may hide the quad; the quad never hides itself.
      ASSERT_NE(accel.closest(to_quad).id, (PrimitiveId{0, 1}));
      const auto s = sample_sphere_light(g.spheres[0].center, 0.7, p.position, u, v);
      ASSERT_TRUE(s);
      const Ray to_sphere = toward(p, s->position, surface_offset(s->position, 0.7), s->normal);
      ASSERT_NE(accel.closest(to_sphere).id, (PrimitiveId{0, 0}));
    }
  }
}

TEST(Offset, ABlockerNearAReceiverCountsHoweverFarTheLight) {
  Geometry g;
  g.quads.push_back({{-1, 0, -1}, {0, 0, 2}, {2, 0, 0}, {}});
  g.quads.push_back({{-1, 0.5, -1}, {0, 0, 2}, {2, 0, 0}, {}});
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Ray down = {{0, 0.1, 0}, {0, -1, 0}};
  const SurfacePoint p = surface_at(g, down, accel.closest(down));
  EXPECT_TRUE(accel.occluded(toward(p, {0, 1000, 0}, 0)));
  EXPECT_FALSE(accel.occluded(toward(p, {0, 0.5, 0}, 1e-9)));
  EXPECT_FALSE(accel.occluded(toward(p, {0, 0.4, 0}, 0)));
}

}  // namespace
}  // namespace bandsaw
