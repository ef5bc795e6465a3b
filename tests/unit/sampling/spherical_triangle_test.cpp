// Sampling of triangles uniformly in solid angle. An id such as L6 in a test's name is that of a
// case in tests/hard_cases/cases.txt.

#include "renderlib/sampling/spherical_triangle.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/constants.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"

namespace bandsaw {
namespace {

/// The triangle (a, a + u, a + v), seen from `point`.
struct Viewpoint {
  Vec3 point;
  Vec3 a;
  Vec3 u;
  Vec3 v;
};

const std::vector<Viewpoint> kViews = {
    {{0, 0, 0}, {-1, -1, 1}, {3, 0, 0}, {0, 3, 0}},         // above
    {{0, 0, 0}, {-40, -40, 0.05}, {90, 0, 0}, {0, 90, 0}},  // nearly half of all directions
    {{0, 0, 0}, {-1, -1, -0.1}, {3, 0, 0}, {0, 3, 0}},      // close, from the other side
    {{1, 2, 3}, {3, 2, 1}, {0, 1, 1}, {3, 0, 0}},           // slanted
    {{0, 0, 0}, {2, -4, 0.3}, {1, 0, 0}, {0, 9, 0.2}},      // grazing
    {{0, 0, 1}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}},           // above a corner
    {{0, 0, 0}, {-1, -0.25, 1}, {2, 0, 0}, {2, 0.5, 0}}     // thin
};

/// Returns the direction from the viewpoint to a + on.x u + on.y v.
Vec3 at(const Viewpoint& view, const Vec2& on) {
  return normalize(view.a + view.u * on.x + view.v * on.y - view.point);
}

/// Returns true if the direction is within the planes of all three edges, up to rounding.
bool sees(const Viewpoint& view, const Vec3& d) {
  const Vec3 a = view.a - view.point;
  const Vec3 b = a + view.u;
  const Vec3 c = a + view.v;
  const double side = dot(a, cross(b, c)) > 0 ? 1 : -1;
  const auto inside = [&](const Vec3& p, const Vec3& q) {
    return side * dot(d, normalize(cross(p, q))) >= -1e-9;
  };
  return inside(a, b) && inside(b, c) && inside(c, a);
}

TEST(SphericalTriangle, SamplesUniformlyInSolidAngle) {
  std::uint64_t seed = 50;
  for (const Viewpoint& view : kViews) {
    const auto triangle = SphericalTriangle::seen_from(view.point, view.a, view.u, view.v);
    ASSERT_TRUE(triangle);
    test::expect_samples_match_density(
        [&](double s, double t) { return at(view, triangle->sample(s, t)); },
        [&](const Vec3& d) { return sees(view, d) ? 1 / triangle->solid_angle() : 0.0; }, ++seed,
        kViews.size());
  }
}

TEST(SphericalTriangle, SolidAnglesMatchClosedForms) {
  // The octant is an eighth of all directions. The other triangles are halves of squares at the
  // distance 1. A square of half side h has the solid angle 4 asin(h^2 / (h^2 + 1)). With h = 1,
  // the square is the face of a cube, a sixth of all directions.
  const auto octant = SphericalTriangle::seen_from({0, 0, 0}, {1, 0, 0}, {-1, 1, 0}, {-1, 0, 1});
  ASSERT_TRUE(octant);
  EXPECT_NEAR(octant->solid_angle(), kPi / 2, 1e-14);
  const auto half = SphericalTriangle::seen_from({0, 0, 0}, {-1, -1, 1}, {2, 0, 0}, {2, 2, 0});
  ASSERT_TRUE(half);
  EXPECT_NEAR(half->solid_angle(), kPi / 3, 1e-14);
  for (const double h : {0.3, 0.1, 0.03}) {
    const auto small =
        SphericalTriangle::seen_from({0, 0, 0}, {-h, -h, 1}, {2 * h, 0, 0}, {2 * h, 2 * h, 0});
    ASSERT_TRUE(small);
    EXPECT_NEAR(small->solid_angle() / (2 * std::asin(h * h / (h * h + 1))), 1, 1e-12) << h;
  }
}

TEST(SphericalTriangle, IsAbsentForEdgeOnOrSmallTriangles) {
  // The triangles are seen edge-on, from far away, from a corner, and from a point on an edge.
  EXPECT_FALSE(SphericalTriangle::seen_from({0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(SphericalTriangle::seen_from({0, 0, 0}, {0, 0, 1e3}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(SphericalTriangle::seen_from({0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(SphericalTriangle::seen_from({0, 0, 0}, {0.5, 0, 0}, {-1, 0, 0}, {0, 1, 0}));
}

TEST(SphericalTriangle, L6_CornersOfTheUnitSquareStayInside) {
  test::Random random(60);
  std::vector<Viewpoint> views = kViews;
  for (int i = 0; i < 2000; ++i) {
    Viewpoint view;
    for (Vec3* v : {&view.point, &view.a, &view.u, &view.v}) {
      v->x = random.uniform(-1, 1);
      v->y = random.uniform(-1, 1);
      v->z = random.uniform(-1, 1) * (i % 2 == 0 ? 1 : 1e-6);
    }
    views.push_back(view);
  }
  for (const Viewpoint& view : views) {
    const auto triangle = SphericalTriangle::seen_from(view.point, view.a, view.u, view.v);
    if (!triangle) {
      continue;
    }
    for (const double s : {0.0, 0x1p-32, 0.5, 1 - 0x1p-32}) {
      for (const double t : {0.0, 0x1p-32, 0.5, 1 - 0x1p-32}) {
        const Vec2 on = triangle->sample(s, t);
        ASSERT_TRUE(on.x >= 0 && on.y >= 0 && on.x + on.y <= 1 + 1e-15) << on.x << " " << on.y;
      }
    }
  }
  test::report_hard_case("L6", "samples at corners, edges and the middle lie inside the triangle");
}

}  // namespace
}  // namespace bandsaw
