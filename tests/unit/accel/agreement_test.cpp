// Tests that Accel finds the same hits as brute force and as a simple BVH in double, bit for bit.
// The tests use meshes of many kinds, and different numbers of threads that build the BVH. Brute
// force tests all primitives. An id such as B4 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include "tests/unit/accel/agreement.h"
#include "tests/support/hard_case.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

namespace bandsaw::test {
namespace {

struct Case {
  std::string name;
  Mesh mesh;
};

/// A height field over a square.
Mesh terrain(int side) {
  Random random(5);
  Mesh mesh;
  for (int z = 0; z <= side; ++z) {
    for (int x = 0; x <= side; ++x) {
      mesh.positions.push_back(
          {static_cast<float>(x), static_cast<float>(random.uniform(0, 2)), static_cast<float>(z)});
    }
  }
  const auto at = [side](int x, int z) { return static_cast<std::uint32_t>(z * (side + 1) + x); };
  for (int z = 0; z < side; ++z) {
    for (int x = 0; x < side; ++x) {
      mesh.triangles.push_back({at(x, z), at(x + 1, z), at(x, z + 1)});
      mesh.triangles.push_back({at(x + 1, z), at(x + 1, z + 1), at(x, z + 1)});
    }
  }
  return mesh;
}

/// Returns the mesh with `times` copies of every triangle. The further copies are in reverse order.
Mesh repeated(Mesh mesh, int times) {
  const auto once = mesh.triangles;
  for (int i = 1; i < times; ++i) {
    mesh.triangles.insert(mesh.triangles.begin(), once.rbegin(), once.rend());
  }
  return mesh;
}

/// Returns the mesh with its y coordinates multiplied by `by`.
Mesh flattened(Mesh mesh, float by) {
  for (auto& p : mesh.positions) {
    p[1] *= by;
  }
  return mesh;
}

/// Returns triangles whose corners are random points of a small grid. Many of the triangles are
/// degenerate, collinear or coplanar.
Mesh grid_soup(int count) {
  Random random(17);
  Mesh mesh;
  for (int i = 0; i < 64; ++i) {
    mesh.positions.push_back(
        {static_cast<float>(i % 4), static_cast<float>(i / 4 % 4), static_cast<float>(i / 16)});
  }
  for (int i = 0; i < count; ++i) {
    const std::uint32_t a = random.below(64);
    const std::uint32_t b = random.below(64);
    mesh.triangles.push_back({a, b, random.below(64)});
  }
  return mesh;
}

/// Adds four triangles that cannot be hit: two with a vertex that is not finite, one with a vertex
/// that does not exist, and one with two equal vertices.
Mesh with_bad_input(Mesh mesh) {
  const float nan = std::nanf("");
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({nan, 0, 0});
  mesh.positions.push_back({0, HUGE_VALF, 0});
  mesh.triangles.push_back({0, 1, first});
  mesh.triangles.push_back({first + 1, 0, 2});
  mesh.triangles.push_back({0, 1, first + 2});
  mesh.triangles.push_back({3, 3, 4});
  return mesh;
}

/// Returns all meshes with their names. `level`: number of subdivisions of the icospheres.
std::vector<Case> cases(int level) {
  const Mesh sphere = icosphere(level);
  return {
      {"icosphere", sphere},
      {"needles", rough_sphere(200, 12, 6, 1)},
      {"spikes", rough_sphere(48, 24, 6, 2)},
      {"terrain", terrain(24)},
      {"soup", triangle_soup(1500, 0.4, 3)},
      {"small soup", triangle_soup(1500, 1e-4, 4)},
      {"grid soup", grid_soup(1000)},
      {"moved 1e3", moved(sphere, {1e3, -2e3, 3e3})},
      {"moved 1e6", moved(sphere, {1e6, 1e6, -1e6})},
      {"large", scaled(sphere, 1e6)},
      {"small", scaled(sphere, 1e-6)},
      {"tiny", scaled(sphere, 1e-10)},
      {"beyond float", scaled(sphere, 1e30)},
      {"denormal", scaled(sphere, 1e-41)},
      {"repeated", repeated(sphere, 3)},
      {"flat", flattened(sphere, 0)},
      {"nearly flat", flattened(sphere, 1e-6f)},
      {"bad input", with_bad_input(sphere)},
  };
}

TEST(Agreement, EqualsBruteForceOnSmallMeshes) {
  Pool pool(2);
  for (const Case& c : cases(2)) {
    SCOPED_TRACE(c.name);
    const Geometry geometry = scene_of(c.mesh);
    const Accel accel = Accel::build(geometry, pool);
    const ReferenceAccel brute(geometry, true);
    const Box box = box_of(c.mesh);
    Random random(11);
    const Agreement agreement =
        compare(accel, brute, 1000, [&] { return aimed_ray(c.mesh, box, random); });
    EXPECT_EQ(agreement.different, 0);
    // All rays of the flat mesh lie in its plane, so none of them needs to hit it.
    EXPECT_GT(agreement.hits, c.name == "flat" ? -1 : agreement.rays / 10);
  }
}

TEST(Agreement, EqualsABinaryTreeInDouble) {
  Pool pool(2);
  for (const Case& c : cases(4)) {
    SCOPED_TRACE(c.name);
    if (c.name == "beyond float" || c.name == "denormal") {
      // Floats cannot decide any test at this size. Accel then repeats each test in double, which
      // is correct but slow.
      continue;
    }
    const Geometry geometry = scene_of(c.mesh);
    const Accel accel = Accel::build(geometry, pool);
    const ReferenceAccel reference(geometry);
    const Box box = box_of(c.mesh);
    Random random(12);
    const Agreement agreement =
        compare(accel, reference, 10'000, [&] { return aimed_ray(c.mesh, box, random); });
    EXPECT_EQ(agreement.different, 0);
  }
}

TEST(Agreement, HoldsForOriginsFarAway) {
  Pool pool(1);
  for (const double distance : {1e2, 1e4, 1e6, 1e9, 1e12, 1e15, 1e19}) {
    SCOPED_TRACE(distance);
    const Mesh mesh = scaled(icosphere(3), std::max(1.0, distance / 1e12));
    const Geometry geometry = scene_of(mesh);
    const Accel accel = Accel::build(geometry, pool);
    const ReferenceAccel reference(geometry);
    const Box box = box_of(mesh);
    Random random(13);
    const Agreement agreement = compare(accel, reference, 3000, [&] {
      Ray ray = aimed_ray(mesh, box, random);
      ray.direction = ray.origin + ray.direction;
      ray.origin = distance * random_direction(random);
      ray.direction = ray.direction - ray.origin;
      return ray;
    });
    EXPECT_EQ(agreement.different, 0);
    EXPECT_GT(agreement.hits, agreement.rays / 10);
  }
}

TEST(Agreement, B4_HoldsForRaysAlongAxesAndWithinFaces) {
  Pool pool(1);
  const Mesh mesh = grid_soup(600);
  const Geometry geometry = scene_of(mesh);
  const Accel accel = Accel::build(geometry, pool);
  const ReferenceAccel brute(geometry, true);
  Random random(14);
  const double parts[] = {0, -0.0, 1, -1, 1e-12, -1e-30, 0.5};
  const auto pick = [&] { return parts[random.below(7)]; };
  const auto place = [&] { return 0.5 * random.below(8) - 0.5; };
  const Agreement agreement = compare(accel, brute, 20'000, [&] {
    Ray ray;
    ray.origin.x = place();
    ray.origin.y = place();
    ray.origin.z = place();
    ray.direction.x = pick();
    ray.direction.y = pick();
    ray.direction.z = pick();
    return ray;
  });
  EXPECT_EQ(agreement.different, 0);
  report_hard_case("B4",
                   "20,000 rays with direction components 0, -0, 1e-30: hits equal brute force");
}

/// Returns a random point of the cube [-size, size]^3.
Vec3 scatter(Random& random, double size) { return size * random_point(random); }

/// Returns a scene of loose shapes (shapes that are in no instance) of three kinds, and of
/// instances of a mesh that are rotated, mirrored, stretched and small. All of them lie around
/// `at`, within a distance of about `size`. The scene also has equal shapes, an instance of an
/// empty mesh, and an instance whose placement has no inverse.
Geometry mixed_scene(const Vec3& at, double size) {
  Random random(21);
  Geometry g;
  for (int i = 0; i < 300; ++i) {
    const double radius = size * random.uniform(0.001, 0.1);
    g.spheres.push_back({at + scatter(random, size), radius, MaterialId{0}});
    Quad quad;
    quad.corner = at + scatter(random, size);
    quad.u = scatter(random, 0.3 * size);
    quad.v = scatter(random, 0.3 * size);
    g.quads.push_back(quad);
    Triangle triangle;
    triangle.a = at + scatter(random, size);
    triangle.b = triangle.a + scatter(random, 0.3 * size);
    triangle.c = triangle.a + scatter(random, 0.3 * size);
    g.triangles.push_back(triangle);
  }
  g.spheres.push_back(g.spheres.front());
  g.quads.push_back(g.quads.front());
  g.triangles.push_back(g.triangles.front());
  g.meshes.push_back(rough_sphere(24, 12, 2, 3));
  g.meshes.push_back(Mesh{});
  for (int i = 0; i < 40; ++i) {
    const double sign = i % 2 == 0 ? 1 : -1;
    const Vec3 by = {0.05 * size, sign * size * random.uniform(0.01, 0.2), 0.1 * size};
    const Vec3 to = at + scatter(random, size);
    const Vec3 axis = random_direction(random);
    const Transform place = translation(to) * rotation(axis, 360 * random.uniform()) * scaling(by);
    g.instances.push_back({MeshId{0}, MaterialId{0}, place});
  }
  g.instances.push_back(g.instances.front());
  g.instances.push_back({MeshId{1}, MaterialId{0}, {}});
  g.instances.push_back({MeshId{0}, MaterialId{0}, scaling({1, 0, 1})});
  return g;
}

TEST(Agreement, HoldsForLooseShapesAndInstances) {
  Pool pool(2);
  const std::pair<double, double> places[] = {{0, 1},     {1e4, 1},    {1e6, 10}, {0, 1e-6},
                                              {3e5, 1e6}, {1e10, 1e6}, {0, 1e10}, {0, 1e15}};
  for (const auto& place : places) {
    const double offset = place.first;
    const double size = place.second;
    SCOPED_TRACE(offset);
    const Vec3 at = offset * Vec3{1, -0.5, 0.3};
    const Geometry geometry = mixed_scene(at, size);
    const Accel accel = Accel::build(geometry, pool);
    const ReferenceAccel reference(geometry);
    Random random(22);
    const Agreement agreement = compare(accel, reference, 4000, [&] {
      Ray ray;
      ray.origin = at + scatter(random, 3 * size);
      Vec3 target = at + scatter(random, size);
      const Quad& quad = geometry.quads[random.below(300)];
      const Sphere& sphere = geometry.spheres[random.below(300)];
      switch (random.below(4)) {
        case 0:
          target = quad.corner + random.uniform() * (quad.u + quad.v);
          break;
        case 1:
          target = quad.corner + random.uniform() * quad.u;
          break;
        case 2:
          target = sphere.center + sphere.radius * random_direction(random);
          break;
        default:
          break;
      }
      ray.direction = target - ray.origin;
      return ray;
    });
    EXPECT_EQ(agreement.different, 0);
    EXPECT_GT(agreement.hits, agreement.rays / 2);
  }
}

TEST(Agreement, HoldsForAnyNumberOfBuildThreads) {
  const Mesh mesh = rough_sphere(300, 200, 1.1, 7);
  const Geometry geometry = scene_of(mesh);
  Pool one(1);
  Pool three(3);
  const Accel a = Accel::build(geometry, one);
  const Accel b = Accel::build(geometry, three);
  EXPECT_EQ(a.bytes(), b.bytes());
  EXPECT_LE(a.bytes(), 70 * mesh.triangles.size());  // about 50 to 55 bytes a triangle
  const Box box = box_of(mesh);
  Random random(8);
  for (int i = 0; i < 20'000; ++i) {
    const Ray ray = aimed_ray(mesh, box, random);
    ASSERT_TRUE(same(a.closest(ray), b.closest(ray)));
  }
}

}  // namespace
}  // namespace bandsaw::test
