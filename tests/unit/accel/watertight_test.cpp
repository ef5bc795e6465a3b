// Closed meshes do not leak: rays from inside, aimed at edges and corners, always hit. An id such
// as T3 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/accel/accel.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

Vec3 corner(const Mesh& mesh, std::uint32_t i) {
  return {mesh.positions[i][0], mesh.positions[i][1], mesh.positions[i][2]};
}

/// Traces `count` rays that start at random points of the cube of half side 0.3 `size` around
/// `inside`. Half of the rays aim at corners, the others at edges. Returns the number of rays that
/// hit nothing, and so escape from the closed mesh.
int escapes(Mesh mesh, const Vec3& inside, double size, int count, std::uint64_t seed) {
  Geometry g;
  g.meshes.push_back(std::move(mesh));
  g.instances.push_back({MeshId{0}, {}, {}});
  const Mesh& m = g.meshes[0];
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  test::Random random(seed);
  int lost = 0;
  for (int i = 0; i < count; ++i) {
    const auto& t = m.triangles[random.below(static_cast<std::uint32_t>(m.triangles.size()))];
    const double s = i % 2 == 0 ? 0 : random.uniform();
    const Vec3 target = lerp(corner(m, t[0]), corner(m, t[1]), s);
    const Vec3 origin = inside + (0.3 * size) * test::random_point(random);
    const Ray ray = {origin, target - origin};
    lost += accel.closest(ray) && accel.occluded(ray) ? 0 : 1;
  }
  return lost;
}

TEST(Watertight, RoundSpheresDoNotLeak) {
  EXPECT_EQ(escapes(test::rough_sphere(48, 24, 1, 1), {}, 1, 100000, 1), 0);
  EXPECT_EQ(escapes(test::icosphere(4), {}, 1, 100000, 2), 0);
}

TEST(Watertight, NeedlesAndSpikesDoNotLeak) {
  EXPECT_EQ(escapes(test::rough_sphere(200, 12, 1, 1), {}, 1, 100000, 3), 0);
  EXPECT_EQ(escapes(test::rough_sphere(48, 24, 6, 2), {}, 1, 100000, 4), 0);
  EXPECT_EQ(escapes(test::rough_sphere(200, 12, 6, 3), {}, 1, 100000, 5), 0);
}

TEST(Watertight, MeshesFarFromTheOriginDoNotLeak) {
  for (const double offset : {1e3, 1e5}) {
    const Vec3 by = {offset, offset / 7, -offset};
    EXPECT_EQ(escapes(test::moved(test::icosphere(3), by), by, 1, 50000, 6), 0) << offset;
  }
}

TEST(Watertight, AFlattenedMeshDoesNotLeak) {
  Mesh mesh = test::icosphere(3);
  for (auto& p : mesh.positions) {
    p[1] *= 1e-6f;
  }
  // With size 0 all rays start at the middle, because the mesh is too thin for other origins.
  EXPECT_EQ(escapes(mesh, {}, /*size=*/0, 20000, 7), 0);
}

TEST(Watertight, T3_MeshesOfEveryScaleDoNotLeakAndHaveEqualHits) {
  const Mesh mesh = test::rough_sphere(48, 24, 1.5, 8);
  for (const double scale : {0x1p-40, 0x1p-20, 1e-6, 0x1p20, 0x1p40}) {
    EXPECT_EQ(escapes(test::scaled(mesh, scale), {}, scale, 20000, 9), 0) << scale;
  }
  Geometry g;
  g.meshes = {mesh, test::scaled(mesh, 0x1p-40), test::scaled(mesh, 0x1p40)};
  g.instances.push_back({MeshId{0}, {}, {}});
  Geometry small = g;
  small.instances[0].mesh = MeshId{1};
  Geometry large = g;
  large.instances[0].mesh = MeshId{2};
  Pool pool(1);
  const Accel accel = Accel::build(g, pool);
  const Accel accel_small = Accel::build(small, pool);
  const Accel accel_large = Accel::build(large, pool);
  test::Random random(10);
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin = 2 * test::random_point(random);
    const Vec3 d = test::random_direction(random);
    const Hit hit = accel.closest({origin, d});
    const Hit hit_small = accel_small.closest({origin * 0x1p-40, d});
    const Hit hit_large = accel_large.closest({origin * 0x1p40, d});
    ASSERT_EQ(hit.id, hit_small.id);
    ASSERT_EQ(hit.id, hit_large.id);
    if (hit) {
      ASSERT_EQ(hit.t, hit_small.t * 0x1p40);
      ASSERT_EQ(hit.t, hit_large.t * 0x1p-40);
    }
  }
  test::report_hard_case("T3",
                         "20,000 rays: ids and t equal to the bit at scales 2^-40, 1, 2^40; none "
                         "of 100,000 rays escapes");
}

}  // namespace
}  // namespace bandsaw
