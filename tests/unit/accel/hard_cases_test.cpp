// Hard cases of BVHs: an empty scene, many equal triangles, and triangles of which each is half as
// large as the one before. One test compares the hits with those of brute force, which tests all
// primitives. An id such as B8 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <cmath>
#include <limits>

#include "tests/support/hard_case.h"
#include "tests/unit/accel/agreement.h"

namespace bandsaw::test {
namespace {

TEST(HardCases, B8_AnEmptySceneIsNeverHit) {
  Pool pool(2);
  Geometry geometry;
  EXPECT_FALSE(Accel::build(geometry, pool).closest({{0, 0, 0}, {0, 0, 1}}));
  geometry = scene_of(Mesh{});
  EXPECT_FALSE(Accel::build(geometry, pool).occluded({{0, 0, 0}, {0, 0, 1}}));
  report_hard_case("B8", "a scene without primitives is never hit");
}

TEST(HardCases, T9_TheFirstOfManyEqualTrianglesIsHit) {
  Pool pool(2);
  Mesh mesh;
  mesh.positions = {{-1, -1, 0}, {1, -1, 0}, {0, 1, 0}};
  mesh.triangles.assign(100'000, {0, 1, 2});
  const Geometry geometry = scene_of(mesh);
  const Hit hit = Accel::build(geometry, pool).closest({{0, 0, -2}, {0, 0, 1}});
  EXPECT_EQ(hit.t, 2);
  EXPECT_EQ(hit.id, (PrimitiveId{1, 0}));
  report_hard_case("T9", "the first of 100,000 equal triangles is hit");
}

TEST(HardCases, B7_HitsOnTrianglesOfHalvingSizesEqualBruteForce) {
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
  // compare() traces 3,000 rays, and two more rays after each of them that hits something.
  EXPECT_GT(agreement.hits, 3000);
  report_hard_case("B7", "3,000 rays at triangles of 120 sizes: hits equal brute force");
}

}  // namespace
}  // namespace bandsaw::test
