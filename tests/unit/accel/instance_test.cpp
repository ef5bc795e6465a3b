// Tests the hits on instances of meshes. Instances are mirrored, stretched or coincident, have very
// different scales, or have a placement without an inverse. An id such as X1 in a test's name is
// that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

/// Returns an icosphere with uvs. The normal at a vertex is the vertex's position.
Mesh smooth_sphere(int levels) {
  Mesh mesh = test::icosphere(levels);
  mesh.normals = mesh.positions;
  for (const auto& p : mesh.positions) {
    mesh.uvs.push_back({p[0], p[1]});
  }
  return mesh;
}

/// Returns a scene of one instance of the mesh.
Geometry placed(const Mesh& mesh, const Transform& to_world) {
  Geometry g;
  g.meshes.push_back(mesh);
  g.instances.push_back({MeshId{0}, MaterialId{3}, to_world});
  return g;
}

/// Returns a ray that starts at the distance 5 from `center` and aims at a random point of the cube
/// of half side `spread` around `center`.
Ray aimed(test::Random& random, const Vec3& center, double spread) {
  const Vec3 origin = center + 5 * test::random_direction(random);
  return {origin, center + spread * test::random_point(random) - origin};
}

// A mirrored instance equals a mesh whose vertices are mirrored and whose winding is reversed. So
// the outside of the mesh stays outside.
TEST(Instance, X1_AMirroredInstanceKeepsItsOutside) {
  const Mesh mesh = smooth_sphere(2);
  Mesh by_hand = mesh;
  for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
    by_hand.positions[i][0] *= -1;
    by_hand.normals[i][0] *= -1;
  }
  for (auto& t : by_hand.triangles) {
    std::swap(t[1], t[2]);
  }
  const Geometry mirrored = placed(mesh, scaling({-1, 1, 1}));
  const Geometry reference = placed(by_hand, {});
  Pool pool(1);
  const Accel accel = Accel::build(mirrored, pool);
  const Accel accel_reference = Accel::build(reference, pool);
  test::Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = aimed(random, {}, 0.8);
    const Hit hit = accel.closest(ray);
    const Hit hit_reference = accel_reference.closest(ray);
    ASSERT_EQ(static_cast<bool>(hit), static_cast<bool>(hit_reference));
    if (!hit) {
      continue;
    }
    const SurfacePoint p = surface_at(mirrored, ray, hit);
    const SurfacePoint q = surface_at(reference, ray, hit_reference);
    ASSERT_NEAR(hit.t, hit_reference.t, 1e-15 * 5);
    ASSERT_LE(length(p.geometric_normal - q.geometric_normal), 1e-12);
    ASSERT_LE(length(p.shading_normal - q.shading_normal), 1e-12);
    ASSERT_GT(dot(p.geometric_normal, p.position), 0.9);
    ASSERT_NEAR(p.uv.x, q.uv.x, 1e-12);
    ASSERT_EQ(p.material, MaterialId{3});
  }
  test::report_hard_case("X1",
                         "5,000 rays: normals within 1e-12 of the normals of a mirrored mesh");
}

// The instance is an ellipsoid. Its shading normals point along the gradient of the ellipsoid's
// equation.
TEST(Instance, X2_StretchedInstancesHaveTheNormalsOfTheirShape) {
  const Vec3 axes = {1, 1, 1e-3};
  const Transform turn = rotation({1, 2, 3}, 40);
  const Geometry g = placed(smooth_sphere(3), turn * scaling(axes));
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  test::Random random(2);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = aimed(random, {}, 0.5);
    const Hit hit = accel.closest(ray);
    if (!hit) {
      continue;
    }
    ++hits;
    const SurfacePoint p = surface_at(g, ray, hit);
    const auto& t = g.meshes[0].triangles[hit.id.primitive];
    Vec3 corners[3];
    for (std::size_t k = 0; k < 3; ++k) {
      const auto& c = g.meshes[0].positions[t[k]];
      corners[k] = turn.point({c[0] * axes.x, c[1] * axes.y, c[2] * axes.z});
    }
    const Vec3 flat = normalize(cross(corners[1] - corners[0], corners[2] - corners[0]));
    ASSERT_LE(length(flat - p.geometric_normal), 1e-10);
    const Vec3 n = corners[0] * (1 - hit.u - hit.v) + corners[1] * hit.u + corners[2] * hit.v;
    const Vec3 local = inverse(turn)->direction(n);
    const Vec3 gradient = normalize(turn.direction(
        {local.x / (axes.x * axes.x), local.y / (axes.y * axes.y), local.z / (axes.z * axes.z)}));
    const bool aligned = dot(gradient, p.geometric_normal) > 0;
    ASSERT_LE(length((aligned ? gradient : -gradient) - p.shading_normal), 1e-9);
    ASSERT_LE(length(p.position - n), 1e-14);
  }
  EXPECT_GT(hits, 1000);
  test::report_hard_case("X2",
                         "more than 1,000 geometric normals within 1e-10 rad of the exact normals");
}

// A scene has two instances that are equal in world space: a large mesh that is scaled down, and a
// small mesh that is scaled up. The first of them is hit. In a second scene the first instance is
// far away, so the second instance is hit, at the same distance.
TEST(Instance, X5_DistancesAreInWorldSpaceAtEveryScale) {
  Geometry g;
  g.meshes = {test::scaled(test::icosphere(1), 0x1p10), test::scaled(test::icosphere(1), 0x1p-10)};
  g.instances.push_back({MeshId{0}, {}, scaling({0x1p-10, 0x1p-10, 0x1p-10})});
  g.instances.push_back({MeshId{1}, {}, scaling({0x1p10, 0x1p10, 0x1p10})});
  Geometry second = g;
  second.instances[0].to_world = translation({100, 0, 0}) * g.instances[0].to_world;
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Accel accel_second = Accel::build(second, pool);
  test::Random random(3);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = aimed(random, {}, 0.8);
    const Hit hit = accel.closest(ray);
    const Hit other = accel_second.closest(ray);
    ASSERT_EQ(static_cast<bool>(hit), static_cast<bool>(other));
    if (hit) {
      ASSERT_EQ(hit.t, other.t);  // equal to the bit, because the scales are powers of two
      ASSERT_EQ(hit.id.instance, 1u);
      ASSERT_EQ(other.id.instance, 2u);
      ASSERT_EQ(hit.id.primitive, other.id.primitive);
    }
  }
  test::report_hard_case("X5", "5,000 rays: t equal to the bit for both instances");
}

TEST(Instance, X6_TheFirstOfCoincidentInstancesIsHit) {
  Geometry g = placed(test::icosphere(2), rotation({1, 1, 0}, 30) * scaling({1, 2, 0.3}));
  for (int copies = 0; copies < 20; ++copies) {
    g.instances.push_back(g.instances[0]);
  }
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  test::Random random(4);
  for (int i = 0; i < 3000; ++i) {
    const Hit hit = accel.closest(aimed(random, {}, 0.5));
    ASSERT_TRUE(!hit || hit.id.instance == 1);
  }
  test::report_hard_case("X6", "3,000 rays: the first of 21 coincident instances is hit");
}

// Rays from the middle of a rotated instance through each corner of its mesh hit the mesh. They
// could miss it if the instance's box in world space did not contain the instance.
TEST(Instance, B11_BoxesContainTheirInstances) {
  Pool pool(1);
  test::Random random(5);
  const Mesh mesh = test::icosphere(1);
  for (int i = 0; i < 300; ++i) {
    const Transform to_world =
        translation(std::pow(10, random.uniform(-2, 5)) * test::random_direction(random)) *
        rotation(test::random_direction(random), random.uniform(0, 360)) *
        scaling(std::pow(10, random.uniform(-2, 2)) * Vec3{1, random.uniform(0.01, 1), -1});
    Geometry g = placed(mesh, to_world);
    g.spheres.push_back({{1e3, 1e3, 1e3}, 1, {}});
    const Accel accel = Accel::build(g, pool);
    for (const auto& p : mesh.positions) {
      const Vec3 corner = to_world.point({p[0], p[1], p[2]});
      const Vec3 middle = to_world.point({0, 0, 0});
      // The mesh is closed around its middle, so a ray from the middle must hit the mesh.
      ASSERT_TRUE(accel.closest({middle, corner - middle}));
      ASSERT_TRUE(accel.occluded({middle, corner - middle}));
    }
  }
  test::report_hard_case("B11", "300 instances: the boxes contain all 42 vertices");
}

TEST(Instance, X3_SingularInstancesAreNeverHit) {
  Geometry g = placed(test::icosphere(1), scaling({1, 0, 1}));
  g.instances.push_back({MeshId{7}, {}, {}});  // this mesh does not exist
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  EXPECT_FALSE(accel.closest({{0, -3, 0}, {0, 1, 0}}));
  test::report_hard_case("X3", "an instance of scale 0 is never hit");
}

}  // namespace
}  // namespace bandsaw
