// Compares Accel, the renderer's BVH, to the bit with brute force, which tests all primitives. The
// cases are hard: ties, borders, planes, extreme shapes and rays. An id such as T5 in a test's name
// is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderlib/accel/accel.h"
#include "renderlib/math/constants.h"
#include "tests/support/brute_force.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

/// Returns a scene of one instance of the mesh, without a transform.
Geometry of_mesh(Mesh mesh) {
  Geometry g;
  g.meshes.push_back(std::move(mesh));
  g.instances.push_back({MeshId{0}, MaterialId{0}, {}});
  return g;
}

/// Expects that Accel finds the same hit as brute force for each ray, to the bit.
void expect_exact(const Geometry& g, const std::vector<Ray>& rays) {
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  for (const Ray& ray : rays) {
    const Hit truth = test::closest_by_brute_force(g, ray);
    const Hit found = accel.closest(ray);
    ASSERT_TRUE(test::same_hit(found, truth))
        << "expected t " << truth.t << " and id " << truth.id.instance << ":" << truth.id.primitive
        << ", but found t " << found.t << " and id " << found.id.instance << ":"
        << found.id.primitive;
    ASSERT_EQ(accel.occluded(ray), static_cast<bool>(truth));
  }
}

/// Returns rays that start at random points of the cube [-spread, spread]^3. Most of them aim at a
/// point of [-1, 1]^3. A quarter of the rays have a finite length.
std::vector<Ray> random_rays(int count, double spread, std::uint64_t seed) {
  test::Random random(seed);
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const Vec3 origin = spread * test::random_point(random);
    const Vec3 d =
        (random.below(3) == 0 ? test::random_point(random) : test::random_point(random) - origin);
    rays.push_back({origin, d, random.below(4) == 0 ? random.uniform(0, 2) : kInfinity});
  }
  return rays;
}

/// Returns rays that start at points of a grid. Components of their directions are numbers such as
/// 0, -0, 1 and 1e-12. For this reason, many of the rays lie within the planes of the squares of
/// lattice(), or meet the edges and corners of these squares.
std::vector<Ray> grid_rays(int count, std::uint64_t seed) {
  test::Random random(seed);
  const double parts[] = {0, -0.0, 1, -1, 1e-12, -1e-12, 0.5, 1e-320};
  const auto coordinate = [&random] { return static_cast<double>(random.below(9)) / 4 - 1; };
  std::vector<Ray> rays;
  for (int i = 0; i < count; ++i) {
    const double x = parts[random.below(8)];
    const double y = parts[random.below(8)];
    const Vec3 d = {x, y, parts[random.below(8)]};
    const double ox = coordinate();
    const double oy = coordinate();
    rays.push_back({{ox, oy, coordinate()}, d, random.below(3) == 0 ? 1.5 : kInfinity});
  }
  return rays;
}

/// Returns axis-parallel squares of two triangles each, at random places of a grid. Many of the
/// squares coincide.
Mesh lattice(std::uint64_t seed) {
  test::Random random(seed);
  Mesh mesh;
  for (int i = 0; i < 300; ++i) {
    const std::size_t axis = random.below(3);
    std::array<float, 3> corner;
    for (float& c : corner) {
      c = static_cast<float>(random.below(8)) / 4 - 1;
    }
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const auto& [a, b] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
      auto p = corner;
      p[(axis + 1) % 3] += 0.25f * static_cast<float>(a);
      p[(axis + 2) % 3] += 0.25f * static_cast<float>(b);
      mesh.positions.push_back(p);
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  }
  return mesh;
}

TEST(AccelExact, HitsOnRandomTrianglesEqualBruteForce) {
  expect_exact(of_mesh(test::triangle_soup(300, 0.5, 1)), random_rays(3000, 2, 2));
  expect_exact(of_mesh(test::triangle_soup(1000, 0.02, 3)), random_rays(1000, 1, 4));
}

TEST(AccelExact, T5_HitsOfRaysAlongPlanesEdgesAndCornersEqualBruteForce) {
  expect_exact(of_mesh(lattice(1)), grid_rays(4000, 2));
  // A leaf of the tree has eight lanes with one triangle each.
  test::report_hard_case(
      "T5", "4,000 rays within planes: hits equal brute force in every lane of a leaf");
}

TEST(AccelExact, HitsOnNeedlesAndSpikesFarFromTheOriginEqualBruteForce) {
  const Mesh spikes = test::rough_sphere(60, 8, 6, 3);
  for (const double offset : {0.0, 1e3, 1e5}) {
    const Vec3 by = {offset, -offset, offset / 3};
    std::vector<Ray> rays = random_rays(1500, 3, 5);
    for (Ray& ray : rays) {
      ray.origin = ray.origin + by;
    }
    expect_exact(of_mesh(test::moved(spikes, by)), rays);
  }
}

TEST(AccelExact, HitsOfRaysAimedAtEdgesAndCornersEqualBruteForce) {
  for (const double offset : {0.0, 1e5}) {
    const Mesh mesh = test::moved(test::icosphere(2), {offset, 0, 0});
    test::Random random(6);
    std::vector<Ray> rays;
    for (int i = 0; i < 3000; ++i) {
      const auto& t =
          mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
      const auto& p = mesh.positions[t[0]];
      const auto& q = mesh.positions[t[1]];
      const double s = random.below(2) == 0 ? 0 : random.uniform();
      const Vec3 target = lerp(Vec3{p[0], p[1], p[2]}, Vec3{q[0], q[1], q[2]}, s);
      const Vec3 origin = Vec3{offset, 0, 0} + 3 * test::random_point(random);
      rays.push_back({origin, target - origin});
    }
    expect_exact(of_mesh(mesh), rays);
  }
}

TEST(AccelExact, HitsOnLooseShapesOfEveryKindEqualBruteForce) {
  test::Random random(7);
  Geometry g;
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = test::random_point(random);
    g.spheres.push_back({p, random.uniform(0.01, 0.2), {}});
    g.quads.push_back({test::random_point(random),
                       0.3 * test::random_direction(random),
                       0.3 * test::random_direction(random),
                       {}});
    const Vec3 q = test::random_point(random);
    g.triangles.push_back({q,
                           q + 0.3 * test::random_direction(random),
                           q + 0.3 * test::random_direction(random),
                           {}});
  }
  g.meshes.push_back(test::icosphere(1));
  g.instances.push_back({MeshId{0}, {}, translation({0.5, 0, 0}) * scaling({0.2, 0.1, -0.3})});
  g.instances.push_back({MeshId{0}, {}, rotation({1, 1, 0}, 50) * scaling({0.2, 0.5, 0.02})});
  expect_exact(g, random_rays(6000, 1.5, 8));
}

// Ray::from is the primitive on which the ray starts. If it is flat, it cannot be hit again.
TEST(AccelExact, HitsOfRaysThatStartOnAPrimitiveEqualBruteForce) {
  Geometry g = of_mesh(test::icosphere(1));
  g.quads.push_back({{-2, 0, -2}, {4, 0, 0}, {0, 0, 4}, {}});
  g.spheres.push_back({{0, 3, 0}, 1, {}});
  std::vector<Ray> rays = random_rays(2000, 2, 9);
  test::Random random(10);
  for (Ray& ray : rays) {
    ray.from =
        random.below(3) == 0 ? PrimitiveId{1, random.below(80)} : PrimitiveId{0, random.below(2)};
  }
  expect_exact(g, rays);
}

// The mesh has every triangle twice, in random order, and the scene has two instances of this mesh.
// If a ray meets several triangles at the same distance, it hits the one with the lowest id.
TEST(AccelExact, T7_TiesGoToTheLowestIdInAnyOrder) {
  test::Random random(11);
  const Mesh mesh = test::icosphere(2);
  Mesh doubled = mesh;
  doubled.triangles.insert(doubled.triangles.end(), mesh.triangles.begin(), mesh.triangles.end());
  for (std::size_t i = doubled.triangles.size() - 1; i > 0; --i) {
    std::swap(doubled.triangles[i],
              doubled.triangles[random.below(static_cast<std::uint32_t>(i + 1))]);
  }
  Geometry g = of_mesh(doubled);
  g.instances.push_back(g.instances[0]);
  expect_exact(g, random_rays(1500, 2, 12));
  test::report_hard_case("T7",
                         "1,500 rays: the lowest id is hit, and hits equal brute force to the bit");
}

TEST(AccelExact, B7_HitsOnTrianglesOfHalvingSizesEqualBruteForce) {
  Geometry g;
  for (int i = 0; i < 200; ++i) {
    const double size = std::ldexp(1, 60 - i);
    g.triangles.push_back({{0, 0, size}, {size, 0, size}, {0, size, size}, {}});
  }
  std::vector<Ray> rays;
  test::Random random(13);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d = {random.uniform(0, 0.6), random.uniform(0, 0.6), 1};
    rays.push_back({std::ldexp(1, static_cast<int>(random.below(120)) - 70) * d * 0.3, d});
  }
  expect_exact(g, rays);
}

}  // namespace
}  // namespace bandsaw
