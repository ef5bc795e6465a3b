#include <cmath>
#include <limits>

#include "tests/support/hard_case.h"
#include "tests/unit/accel/agreement.h"

namespace bandsaw::test {
namespace {

/// Rays from within a closed mesh at its corners and edges: how many get out.
int leaks(const Mesh& mesh, const Vec3& origin_at, double origin_size, int count) {
  Pool pool(2);
  const Geometry geometry = scene_of(mesh);
  const Accel accel = Accel::build(geometry, pool);
  Random random(31);
  int missed = 0;
  for (int i = 0; i < count; ++i) {
    const auto& triangle =
        mesh.triangles[random.below(static_cast<std::uint32_t>(mesh.triangles.size()))];
    const auto corner = [&](std::size_t k) {
      const auto& p = mesh.positions[triangle[k]];
      return Vec3{p[0], p[1], p[2]};
    };
    const Vec3 origin = origin_at + origin_size * random_point(random);
    const Vec3 target = i % 2 == 0 ? corner(0) : lerp(corner(0), corner(1), random.uniform());
    const Ray ray{origin, target - origin};
    missed += accel.closest(ray) && accel.occluded(ray) ? 0 : 1;
  }
  return missed;
}

TEST(Leaks, NoneAtCornersAndEdgesOfClosedMeshes) {
  constexpr int kRays = 150'000;
  EXPECT_EQ(leaks(icosphere(6), {}, 0.5, kRays), 0);
  EXPECT_EQ(leaks(rough_sphere(500, 12, 3, 1), {}, 0.2, kRays), 0) << "needles";
  EXPECT_EQ(leaks(rough_sphere(200, 100, 6, 2), {}, 0.2, kRays), 0) << "spikes";
  EXPECT_EQ(leaks(scaled(icosphere(5), 1e6), {}, 5e5, kRays), 0);
  EXPECT_EQ(leaks(scaled(icosphere(5), 1e-6), {}, 5e-7, kRays), 0);
  EXPECT_EQ(leaks(scaled(icosphere(5), 1e-10), {}, 5e-11, kRays), 0);
  EXPECT_EQ(leaks(moved(icosphere(4), {1e5, -1e5, 1e5}), {1e5, -1e5, 1e5}, 0.5, kRays), 0);
}

TEST(HardCases, RaysThatAreNoRaysHitNothing) {
  Pool pool(1);
  const Geometry geometry = scene_of(icosphere(2));
  const Accel accel = Accel::build(geometry, pool);
  const double nan = std::nan("");
  for (const double bad : {nan, kInfinity, -kInfinity}) {
    for (const Ray& ray :
         {Ray{{bad, 0, 0}, {0, 0, 1}}, Ray{{0, bad, 0}, {0, 0, 1}}, Ray{{0, 0, 0}, {bad, 0, 1}},
          Ray{{0, 0, 0}, {0, 1, bad}}, Ray{{0, 0, 0}, {0, 0, 0}}, Ray{{0, 0, 0}, {0, 0, 1}, nan},
          Ray{{0, 0, 0}, {0, 0, 1}, 0}, Ray{{0, 0, 0}, {0, 0, 1}, -1}}) {
      EXPECT_FALSE(accel.closest(ray));
      EXPECT_FALSE(accel.occluded(ray));
    }
  }
}

TEST(HardCases, B8_NothingToHit) {
  Pool pool(2);
  Geometry geometry;
  EXPECT_FALSE(Accel::build(geometry, pool).closest({{0, 0, 0}, {0, 0, 1}}));
  geometry = scene_of(Mesh{});
  EXPECT_FALSE(Accel::build(geometry, pool).occluded({{0, 0, 0}, {0, 0, 1}}));
  holds("B8", "nothing is hit where nothing is");
}

TEST(HardCases, T9_ManyEqualTriangles) {
  Pool pool(2);
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(100'000, {0, 1, 2});
  const Geometry geometry = scene_of(mesh);
  const Hit hit = Accel::build(geometry, pool).closest({{0, 0, -2}, {0, 0, 1}});
  EXPECT_EQ(hit.t, 2);
  EXPECT_EQ(hit.id, (PrimitiveId{1, 0}));
  holds("T9", "the first of 100,000 equal triangles is hit");
}

TEST(HardCases, B7_SizesThatHalveAHundredTimes) {
  Pool pool(1);
  Mesh mesh;
  for (int i = 0; i < 120; ++i) {
    const float size = std::ldexp(1.0f, -i);
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), {{size, 0, 0}, {size, size, 0}, {size, 0, size}});
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  const Geometry geometry = scene_of(mesh);
  const Accel accel = Accel::build(geometry, pool);
  const ReferenceAccel brute(geometry, true);
  Random random(33);
  const Agreement agreement = compare(accel, brute, 3000, [&] {
    const double size = std::ldexp(1.0, -static_cast<int>(random.below(110)));
    const double y = random.uniform() * size / 2;
    return Ray{{2, y, random.uniform() * size / 2}, {-1, 0, 0}};
  });
  EXPECT_EQ(agreement.different, 0);
  EXPECT_GT(agreement.hits, 3000);
  holds("B7", "3,000 rays among 120 sizes answered as by testing all");
}

}  // namespace
}  // namespace bandsaw::test
