// Single triangles and quads; meshes are tested in tests/unit/accel. An id such as T5 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <optional>

#include "renderlib/geometry/intersect.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Wide;
using test::WideVec;

/// Returns where the ray hits the shape; std::nullopt if it misses the shape.
template <class Shape>
std::optional<Crossing> hit(const Vec3& origin, const Vec3& direction, const Shape& shape) {
  Crossing crossing;
  if (!intersect(trace_setup(origin, direction, kInfinity), shape, crossing)) {
    return std::nullopt;
  }
  return crossing;
}

TEST(Triangle, ReturnsTheWeightsOfItsSecondAndThirdCorner) {
  const Triangle t = {{0, 0, 1}, {2, 0, 1}, {0, 4, 1}, {}};
  const auto inside = hit({0.5, 1, 0}, {0, 0, 3}, t);
  ASSERT_TRUE(inside);
  EXPECT_NEAR(inside->t, 1.0 / 3, 1e-16);
  EXPECT_EQ(inside->u, 0.25);
  EXPECT_EQ(inside->v, 0.25);
  EXPECT_EQ(hit({2, 0, 0}, {0, 0, 1}, t)->u, 1);
  EXPECT_EQ(hit({0, 4, 0}, {0, 0, 1}, t)->v, 1);
  EXPECT_EQ(hit({0.5, 1, 5}, {0, 0, -1}, t)->t, 4);  // both sides can be hit
  EXPECT_FALSE(hit({0.5, 1, 2}, {0, 0, 1}, t));      // the triangle is behind the ray
  EXPECT_FALSE(hit({1.5, 3, 0}, {0, 0, 1}, t));
}

TEST(Triangle, T5_EdgeOnHitsAreFiniteAndInsideTheBox) {
  test::Random random(2);
  for (int i = 0; i < 20000; ++i) {
    const Triangle t = {
        test::random_point(random), test::random_point(random), test::random_point(random), {}};
    const Vec3 in_plane = lerp(t.a, t.b, random.uniform());
    const Vec3 origin = t.c + 5 * (in_plane - t.c) * (random.below(2) == 0 ? 1 : -1);
    const auto found = hit(origin, in_plane - origin, t);
    if (found) {
      const Vec3 p = origin + found->t * (in_plane - origin);
      const Box box = bounds(t);
      for (int k = 0; k < 3; ++k) {
        ASSERT_GE(p[k], box.lo[k] - 1e-11);
        ASSERT_LE(p[k], box.hi[k] + 1e-11);
      }
    }
  }
  test::report_hard_case(
      "T5", "20,000 rays within the plane: hits are finite and inside the triangle's box");
}

// A ray from anywhere through an edge hits at least one of the two triangles that share the edge.
TEST(Triangle, SharedEdgesDoNotLeak) {
  test::Random random(3);
  for (int i = 0; i < 100000; ++i) {
    const double offset = std::pow(10, random.uniform(-3, 6));
    const Vec3 shift = offset * test::random_direction(random);
    const Vec3 a = shift + test::random_point(random);
    const Vec3 b = shift + test::random_point(random);
    const Vec3 c = shift + test::random_point(random);
    // Seen from c, the point d is beyond the edge from a to b.
    const Vec3 d = a + b - c + 0.1 * test::random_point(random);
    const Vec3 origin = shift + 3 * test::random_direction(random);
    const Vec3 target = lerp(a, b, random.uniform(0.01, 0.99));
    const bool left = hit(origin, target - origin, Triangle{a, b, c, {}}).has_value();
    const bool right = hit(origin, target - origin, Triangle{b, a, d, {}}).has_value();
    // If c and d are on the same side of the edge as seen along the ray, the ray may miss both
    // triangles.
    const Vec3 across = cross(b - a, target - origin);
    if (dot(across, c - a) * dot(across, d - a) < -1e-6 * length_squared(across)) {
      ASSERT_TRUE(left || right) << offset;
    }
  }
}

TEST(Quad, ReturnsTheCoordinatesAlongItsSides) {
  const Quad q = {{1, 1, 0}, {4, 0, 0}, {0, 2, 0}, {}};
  const auto lower = hit({4, 1.5, 7}, {0, 0, -1}, q);
  ASSERT_TRUE(lower);
  EXPECT_EQ(lower->t, 7);
  EXPECT_EQ(lower->u, 0.75);
  EXPECT_EQ(lower->v, 0.25);
  const auto upper = hit({2, 2.5, -1}, {0, 0, 2}, q);
  ASSERT_TRUE(upper);
  EXPECT_EQ(upper->t, 0.5);
  EXPECT_EQ(upper->u, 0.25);
  EXPECT_EQ(upper->v, 0.75);
  EXPECT_TRUE(hit({1, 1, 1}, {0, 0, -1}, q));
  EXPECT_TRUE(hit({5, 3, 1}, {0, 0, -1}, q));
  EXPECT_FALSE(hit({5.01, 2, 1}, {0, 0, -1}, q));
}

/// The parameters of the intersection of a ray with the plane of a quad, in higher precision.
struct Truth {
  Wide t;
  Wide u;
  Wide v;
};

/// Returns the parameters for the ray from `origin` and the quad `q`.
Truth truth(const Vec3& origin, const Vec3& direction, const Quad& q) {
  const WideVec n = cross(WideVec(q.u), WideVec(q.v));
  const WideVec to = WideVec(q.corner) - origin;
  const Wide t = dot(n, to) / dot(n, direction);
  const WideVec p = WideVec(direction) * t - to;
  const Wide n2 = dot(n, n);
  return {t, dot(cross(p, WideVec(q.v)), n) / n2, dot(cross(WideVec(q.u), p), n) / n2};
}

TEST(Quad, Q2_SliversHaveAccurateCoordinates) {
  test::Random random(5);
  const std::vector<Quad> slivers = {
      {{1, 2, 3}, {1, 0, 0}, {1, 1e-6, 0}, {}},
      {{0, 0, 0}, {1e8, 0, 0}, {0, 0.6, 0.8}, {}},
      {{0, 0, 0}, {0, 1e-4, 0}, {0, 0, 1e4}, {}},
  };
  for (const Quad& q : slivers) {
    for (int i = 0; i < 5000; ++i) {
      const double a = random.uniform(0.01, 0.99);
      const double b = random.uniform(0.01, 0.99);
      const Vec3 target = q.corner + a * q.u + b * q.v;
      const Vec3 n = normalize(cross(q.u, q.v));
      const Vec3 origin = target + random.uniform(1, 5) * n + 0.1 * test::random_point(random);
      const Vec3 d = target - origin;
      const Truth t = truth(origin, d, q);
      const auto found = hit(origin, d, q);
      ASSERT_TRUE(found);
      ASSERT_NEAR(found->u, static_cast<double>(t.u), 1e-9);
      ASSERT_NEAR(found->v, static_cast<double>(t.v), 1e-9);
    }
  }
  test::report_hard_case(
      "Q2", "coordinates of 15,000 hits within 1e-9 of coordinates computed with 113-bit numbers");
}

TEST(Quad, Q3_GrazingRaysFromFarAwayHitCorrectly) {
  test::Random random(6);
  const Quad q = {{-1, 0, -1}, {2, 0, 0}, {0, 0, 2}, {}};
  int hits = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 origin = {-1e6, 1e-3, 0.1 * random.uniform()};  // an angle of 1e-9
    const Vec3 target = {random.uniform(-1.5, 1.5), 0, random.uniform(-0.5, 0.5)};
    const Vec3 d = target - origin;
    const Truth t = truth(origin, d, q);
    const auto inside = [](Wide x) { return x > 1e-9 && x < 1 - 1e-9; };
    const auto outside = [](Wide x) { return x < -1e-9 || x > 1 + 1e-9; };
    const auto found = hit(origin, d, q);
    if (inside(t.u) && inside(t.v)) {
      ASSERT_TRUE(found);
      ASSERT_NEAR(found->u, static_cast<double>(t.u), 1e-7);
      ++hits;
    } else if (outside(t.u) || outside(t.v)) {
      ASSERT_FALSE(found);
    }
  }
  EXPECT_GT(hits, 10000);
  test::report_hard_case(
      "Q3",
      "20,000 rays: hit or miss as computed with 113-bit numbers, except within 1e-9 of an edge");
}

// A light lies in the plane of the ceiling, and rays through the light hit both quads. Both hits
// must have the same t. Then the quad with the lower id counts as the hit, and a shadow ray to the
// light ends before the ceiling.
TEST(Quad, Q4_CoplanarQuadsAreHitAtTheSameDistance) {
  test::Random random(7);
  const Quad light = {{213, 554, 227}, {130, 0, 0}, {0, 0, 105}, {}};
  const Quad ceiling = {{555, 554, 555}, {-555, 0, 0}, {0, 0, -555}, {}};
  for (int i = 0; i < 10000; ++i) {
    const Vec3 origin = {random.uniform(0, 555), random.uniform(0, 553), random.uniform(0, 555)};
    const Vec3 target =
        light.corner + random.uniform(0.01, 0.99) * light.u + random.uniform(0.01, 0.99) * light.v;
    const auto a = hit(origin, target - origin, light);
    const auto b = hit(origin, target - origin, ceiling);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->t, b->t);
  }
  test::report_hard_case("Q4", "10,000 rays: t of light and ceiling equal to the bit");
}

}  // namespace
}  // namespace bandsaw
