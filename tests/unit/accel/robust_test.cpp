// Tests Accel, the renderer's BVH, with bad and unusual input: empty scenes, invalid rays, bad
// primitives and normals, and many equal triangles. Bad primitives do not change the hits on other
// geometry. An id such as Q7 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/surface.h"
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
  g.instances.push_back({MeshId{0}, {}, {}});
  return g;
}

TEST(AccelRobust, Q7B8_EmptyScenesAreMissedAndASingleQuadIsHit) {
  Pool pool(1);
  const Geometry nothing;
  EXPECT_FALSE(Accel::build(nothing, pool).closest({{0, 0, 0}, {0, 0, 1}}));
  EXPECT_FALSE(Accel::build(nothing, pool).occluded({{0, 0, 0}, {0, 0, 1}}));
  const Geometry empty_mesh = of_mesh({});
  EXPECT_FALSE(Accel::build(empty_mesh, pool).closest({{0, 0, 0}, {0, 0, 1}}));
  Geometry one;
  one.quads.push_back({{-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, {}});  // its box has no thickness
  const Accel accel = Accel::build(one, pool);
  EXPECT_EQ(accel.closest({{0.3, 0, -1}, {0, 0, 1}}).t, 1);
  EXPECT_FALSE(accel.closest({{0.3, 2, -1}, {0, 0, 1}}));
  test::report_hard_case("Q7", "a quad whose box has no thickness is hit, without padding");
}

TEST(AccelRobust, B5_InvalidRaysHitNothing) {
  const Geometry g = of_mesh(test::icosphere(3));
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, kInfinity, -kInfinity}) {
    for (int k = 0; k < 3; ++k) {
      const Vec3 v = {k == 0 ? bad : 0.1, k == 1 ? bad : 0.1, k == 2 ? bad : 0.1};
      EXPECT_FALSE(accel.closest({v, {0, 0, 1}}));
      EXPECT_FALSE(accel.closest({{0, 0, 0}, v}));
      EXPECT_FALSE(accel.occluded({v, {0, 0, 1}}));
    }
  }
  EXPECT_FALSE(accel.closest({{0, 0, 0}, {0, 0, 0}}));
  EXPECT_FALSE(accel.closest({{0, 0, 0}, {0, 0, 1}, nan}));
  EXPECT_FALSE(accel.closest({{0, 0, 0}, {0, 0, 1}, -1}));
  EXPECT_TRUE(accel.closest({{0, 0, 0}, {0, 0, 1e-150}}));
  EXPECT_TRUE(accel.closest({{0, 0, 0}, {0, 0, 1e150}}));
  test::report_hard_case("B5", "30 invalid rays hit nothing");
}

TEST(AccelRobust, T10_BadTrianglesDoNotChangeTheOthers) {
  Mesh mesh = test::icosphere(3);
  const Geometry good = of_mesh(mesh);
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  mesh.positions.push_back({nan, 0, 0});
  mesh.positions.push_back({0, inf, 0});
  mesh.triangles.push_back({0, 1, first});
  mesh.triangles.push_back({0, 1, first + 1});
  mesh.triangles.push_back({0, 1, 0xffffffffu});
  mesh.triangles.push_back({0, 1, 1});
  Geometry bad = of_mesh(mesh);
  bad.spheres.push_back({{nan, 0, 0}, 1, {}});
  bad.quads.push_back({{0, 0, 0}, {kInfinity, 0, 0}, {0, 1, 0}, {}});
  bad.triangles.push_back({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}, {}});
  Pool pool(1);
  const Accel accel = Accel::build(good, pool);
  const Accel accel_bad = Accel::build(bad, pool);
  test::Random random(1);
  for (int i = 0; i < 5000; ++i) {
    const Ray ray = {2 * test::random_point(random), test::random_direction(random)};
    ASSERT_TRUE(test::same_hit(accel.closest(ray), accel_bad.closest(ray)));
  }
  test::report_hard_case("T10", "7 invalid primitives change no bit of the hits of 5,000 rays");
}

TEST(AccelRobust, TheFirstOfManyEqualTrianglesIsHit) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles.assign(100000, {0, 1, 2});
  const Geometry g = of_mesh(std::move(mesh));
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  EXPECT_EQ(accel.closest({{0.2, 0.2, -1}, {0, 0, 1}}).id, (PrimitiveId{1, 0}));
  EXPECT_FALSE(accel.closest({{0.8, 0.8, -1}, {0, 0, 1}}));
}

TEST(AccelRobust, B12_IsTheSameForAnyNumberOfBuildThreads) {
  Geometry g;
  for (int i = 0; i < 8; ++i) {
    g.meshes.push_back(test::triangle_soup(500, 0.2, static_cast<std::uint64_t>(i)));
    g.instances.push_back({MeshId{static_cast<std::uint32_t>(i)}, {}, {}});
  }
  Pool one(1);
  Pool three(3);
  const Accel a = Accel::build(g, one);
  const Accel b = Accel::build(g, three);
  EXPECT_EQ(a.bytes(), b.bytes());
  test::Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Ray ray = {2 * test::random_point(random), test::random_direction(random)};
    ASSERT_TRUE(test::same_hit(a.closest(ray), b.closest(ray)));
  }
  test::report_hard_case("B12", "2,000 hits equal for trees built by 1 and by 3 threads");
}

TEST(Surface, T12_BadNormalsFallBackToTheGeometricOne) {
  Mesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const Ray ray = {{0.25, 0.25, 1}, {0, 0, -1}};
  const Hit hit = {1, {1, 0}, 0.25, 0.25};
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<std::array<float, 3>> normals[] = {
      {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}}, {{nan, 0, 1}, {0, 0, 1}, {0, 0, 1}}, {}};
  for (const auto& n : normals) {
    mesh.normals = n;
    const SurfacePoint p = surface_at(of_mesh(mesh), ray, hit);
    EXPECT_EQ(p.geometric_normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(p.shading_normal, (Vec3{0, 0, 1}));
    EXPECT_EQ(p.uv, (Vec2{0.25, 0.25}));
  }
  mesh.normals = {{0, 0, -1}, {0, 0, -1}, {0, 0, -1}};
  EXPECT_EQ(surface_at(of_mesh(mesh), ray, hit).shading_normal, (Vec3{0, 0, 1}));
  test::report_hard_case("T12", "zero, NaN and opposite vertex normals give the geometric normal");
}

}  // namespace
}  // namespace bandsaw
