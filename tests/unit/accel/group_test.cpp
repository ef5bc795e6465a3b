// Tests instances of groups, and disks. A group is a set of spheres, quads, triangles and disks
// that several instances can place. The placement can make an ellipsoid of a sphere. An id such as
// X2 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "tests/support/brute_force.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Random;

/// Returns `count` random shapes of each kind: spheres, quads, triangles and disks.
Shapes mixed_shapes(int count, std::uint64_t seed) {
  Random random(seed);
  Shapes shapes;
  const auto point = [&] { return test::random_point(random); };
  for (int i = 0; i < count; ++i) {
    shapes.spheres.push_back({point(), random.uniform(0.01, 0.2), {}});
    shapes.quads.push_back({point(), 0.3 * point(), 0.3 * point(), {}});
    shapes.triangles.push_back({point(), point(), point(), {}});
    shapes.disks.push_back(
        {point(), test::random_direction(random), random.uniform(0.01, 0.3), {}});
  }
  return shapes;
}

/// Returns an instance of the group with index `group`.
Instance of_group(std::uint32_t group, const Transform& to_world) {
  Instance instance;
  instance.group = GroupId{group};
  instance.material = kOwnMaterial;
  instance.to_world = to_world;
  return instance;
}

/// Traces `rays` random rays, which start in the cube [-3 size, 3 size]^3 and aim at a point of the
/// cube [-size, size]^3. Expects the same hits as brute force, to the bit, and that more than a
/// tenth of the rays hit something.
void expect_exact(const Geometry& g, int rays, double size, std::uint64_t seed) {
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  Random random(seed);
  int hits = 0;
  for (int i = 0; i < rays; ++i) {
    Ray ray{3 * size * test::random_point(random), {}};
    ray.direction = size * test::random_point(random) - ray.origin;
    const Hit expected = test::closest_by_brute_force(g, ray);
    ASSERT_TRUE(test::same_hit(expected, accel.closest(ray))) << i;
    ASSERT_EQ(accel.occluded(ray), static_cast<bool>(expected));
    if (!expected) {
      continue;
    }
    ++hits;
    // Checks a second ray, which starts at the hit, and the next hit along the first ray.
    const Ray second{ray.origin + expected.t * ray.direction, ray.direction, kInfinity,
                     expected.id};
    ASSERT_TRUE(test::same_hit(test::closest_by_brute_force(g, second), accel.closest(second)));
    const Hit next = accel.closest_after(ray, expected);
    ASSERT_TRUE(!next || next.t > expected.t || (next.t == expected.t && next.id > expected.id));
  }
  EXPECT_GT(hits, rays / 10);
}

TEST(Group, DiskHitsEqualBruteForce) {
  Geometry g;
  static_cast<Shapes&>(g) = mixed_shapes(100, 1);
  expect_exact(g, 6'000, 1, 2);
  Geometry disks;
  disks.disks = mixed_shapes(400, 3).disks;
  expect_exact(disks, 6'000, 1, 4);
}

TEST(Group, InstanceHitsEqualBruteForce) {
  Geometry g;
  g.groups = {mixed_shapes(20, 5), mixed_shapes(1, 6), {}};
  g.meshes.push_back(test::icosphere(1));
  Random random(7);
  for (int i = 0; i < 30; ++i) {
    const double mirror = i % 2 == 0 ? -0.3 : 0.3;
    const Transform to_world =
        translation(test::random_point(random)) *
        rotation(test::random_direction(random), random.uniform(0, 360)) *
        scaling({mirror, random.uniform(0.05, 0.5), random.uniform(0.05, 0.5)});
    g.instances.push_back(of_group(static_cast<std::uint32_t>(i % 3), to_world));
  }
  g.instances.push_back(of_group(0, {}));
  g.instances.push_back({MeshId{0}, {}, scaling({0.4, 0.2, 0.3})});
  expect_exact(g, 4'000, 1.5, 8);
}

TEST(Group, AllSurfacesAlongARayAreHitInOrder) {
  Geometry g;
  g.groups.resize(1);
  g.groups[0].spheres.push_back({{0, 0, 0}, 1, {}});
  g.groups[0].disks.push_back({{0, 0, 0.5}, {0, 0, 1}, 1, {}});
  g.instances.push_back(of_group(0, scaling({1, 1, 2})));
  g.spheres.push_back({{0, 0, 0}, 0.25, {}});
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Ray ray{{0.1, 0, 5}, {0, 0, -1}};
  std::vector<double> met;
  for (Hit hit = accel.closest(ray); hit; hit = accel.closest_after(ray, hit)) {
    met.push_back(5 - hit.t);
  }
  // The ray meets the ellipsoid twice, the disk once and the small sphere twice.
  ASSERT_EQ(met.size(), 5u);
  const double large = 2 * std::sqrt(0.99);
  const double small = std::sqrt(0.0625 - 0.01);
  const double expected[] = {large, 1, small, -small, -large};
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_NEAR(met[i], expected[i], 1e-14);
  }
}

// The normals of a stretched sphere point along the gradient of the ellipsoid's equation.
TEST(Group, X2_AStretchedSphereIsAnEllipsoid) {
  const Vec3 axes = {1, 1, 1e-3};
  const Transform turn = rotation({1, 2, 3}, 40);
  Geometry g;
  g.groups.resize(1);
  g.groups[0].spheres.push_back({{0, 0, 0}, 1, {}});
  g.instances.push_back(of_group(0, turn * scaling(axes)));
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  Random random(9);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    Ray ray{5 * test::random_direction(random), {}};
    ray.direction = 0.5 * test::random_point(random) - ray.origin;
    const Hit hit = accel.closest(ray);
    if (!hit) {
      continue;
    }
    ++hits;
    const SurfacePoint p = surface_at(g, ray, hit);
    const Vec3 local = inverse(turn)->point(p.position);
    const Vec3 gradient = {local.x / (axes.x * axes.x), local.y / (axes.y * axes.y),
                           local.z / (axes.z * axes.z)};
    ASSERT_NEAR(dot(local, gradient), 1, 1e-10) << "the point must be on the ellipsoid";
    ASSERT_LE(length(cross(normalize(turn.direction(gradient)), p.geometric_normal)), 1e-10);
    ASSERT_GT(dot(turn.direction(gradient), p.geometric_normal), 0);
    ASSERT_LE(length(p.position - (ray.origin + hit.t * ray.direction)), 1e-11);
    // Rays that leave outwards do not hit the ellipsoid again. Rays that leave inwards hit its
    // other side.
    ASSERT_FALSE(accel.occluded(spawn_ray(p, p.geometric_normal + 1e-3 * ray.direction)));
    ASSERT_TRUE(accel.occluded(spawn_ray(p, -p.geometric_normal)));
  }
  EXPECT_GT(hits, 3000);
}

// Mirroring a shape does not exchange its inside and its outside.
TEST(Group, X1_MirroredInstancesEqualMirroredShapes) {
  Geometry mirrored;
  mirrored.groups.resize(1);
  Shapes& group = mirrored.groups[0];
  group.spheres.push_back({{0.5, 0.2, 0}, 0.4, {}});
  group.quads.push_back({{-1, -1, -1}, {0.5, 0.1, 0}, {0, 0.7, 0.2}, {}});
  group.triangles.push_back({{0, -1, 0.5}, {0.8, -0.8, 0.4}, {0.2, -0.2, 0.6}, {}});
  group.disks.push_back({{-0.5, 0.6, 0}, normalize(Vec3{1, 2, 0.5}), 0.4, {}});
  mirrored.instances.push_back(of_group(0, scaling({-1, 1, 1})));
  const auto flip = [](const Vec3& p) { return Vec3{-p.x, p.y, p.z}; };
  Geometry by_hand;
  by_hand.spheres.push_back({flip(group.spheres[0].center), 0.4, {}});
  const Quad& quad = group.quads[0];
  by_hand.quads.push_back({flip(quad.corner), flip(quad.v), flip(quad.u), {}});
  const Triangle& t = group.triangles[0];
  by_hand.triangles.push_back({flip(t.a), flip(t.c), flip(t.b), {}});
  by_hand.disks.push_back({flip(group.disks[0].center), flip(group.disks[0].normal), 0.4, {}});
  Pool pool(1);
  const Accel accel = Accel::build(mirrored, pool);
  const Accel expected = Accel::build(by_hand, pool);
  Random random(11);
  int hits = 0;
  for (int i = 0; i < 20'000; ++i) {
    Ray ray{4 * test::random_direction(random), {}};
    ray.direction = test::random_point(random) - ray.origin;
    const Hit a = accel.closest(ray);
    const Hit b = expected.closest(ray);
    ASSERT_EQ(static_cast<bool>(a), static_cast<bool>(b));
    if (a) {
      ++hits;
      ASSERT_EQ(a.id.primitive, b.id.primitive);
      ASSERT_NEAR(a.t, b.t, 1e-14);
      const SurfacePoint p = surface_at(mirrored, ray, a);
      const SurfacePoint q = surface_at(by_hand, ray, b);
      ASSERT_LE(length(p.geometric_normal - q.geometric_normal), 1e-12);
    }
  }
  EXPECT_GT(hits, 2000);
}

// A ray hits the first of 20 coincident instances.
TEST(Group, X6_TheFirstOfCoincidentInstancesIsHit) {
  Geometry g;
  g.groups.push_back(mixed_shapes(3, 12));
  for (int copies = 0; copies < 20; ++copies) {
    g.instances.push_back(of_group(0, rotation({1, 1, 0}, 30) * scaling({1, 2, 0.3})));
  }
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  Random random(13);
  for (int i = 0; i < 3000; ++i) {
    Ray ray{4 * test::random_direction(random), {}};
    ray.direction = test::random_point(random) - ray.origin;
    const Hit hit = accel.closest(ray);
    ASSERT_TRUE(!hit || hit.id.instance == 1);
  }
}

}  // namespace
}  // namespace bandsaw
