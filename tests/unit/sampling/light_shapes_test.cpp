// Sampling of rectangles and spheres uniformly in solid angle. An id such as L6 in a test's name is
// that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <vector>

#include "renderlib/geometry/intersect.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/sphere_light.h"
#include "renderlib/sampling/spherical_rectangle.h"
#include "renderlib/sampling/warp.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

/// Returns true if a ray from `point` along d hits the quad.
bool sees(const Vec3& point, const Vec3& d, const Quad& quad) {
  Crossing crossing;
  return intersect(trace_setup(point, d, kInfinity), quad, crossing);
}

/// A quad that is seen from `point`.
struct View {
  Vec3 point;
  Quad quad;
};

const std::vector<View>& views() {
  static const std::vector<View> all = {
      {{0, 0, 0}, {{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}}},     // above the middle
      {{0, 0, 0}, {{-1, -1, -0.1}, {2, 0, 0}, {0, 2, 0}}},  // close, from the other side
      {{1, 2, 3}, {{3, 2, 1}, {0, 1, 1}, {3, 0, 0}}},       // slanted
      {{0, 0, 0}, {{2, -4, 0.3}, {1, 0, 0}, {0, 9, 0}}},    // grazing
      {{0, 0, 1}, {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}},       // above a corner
  };
  return all;
}

TEST(SphericalRectangle, SamplesUniformlyInSolidAngle) {
  std::uint64_t seed = 10;
  for (const View& view : views()) {
    const Vec3 point = view.point;
    const Quad quad = view.quad;
    const auto rectangle = SphericalRectangle::seen_from(point, quad.corner, quad.u, quad.v);
    ASSERT_TRUE(rectangle);
    test::expect_samples_match_density(
        [&](double u, double v) {
          const Vec2 at = rectangle->sample(u, v);
          return normalize(quad.corner + at.x * quad.u + at.y * quad.v - point);
        },
        [&](const Vec3& d) {
          // Samples may lie on the border up to rounding.
          const Vec3 inwards = quad.corner + 0.5 * quad.u + 0.5 * quad.v - point;
          const bool inside = sees(point, d, quad) || sees(point, d + 1e-9 * inwards, quad);
          return inside ? 1 / rectangle->solid_angle() : 0;
        },
        ++seed);
  }
}

// The solid angle of a rectangle of half sides a, b at distance d above its middle is 4 asin(a b /
// sqrt((a^2+d^2)(b^2+d^2))).
TEST(SphericalRectangle, ComputesSmallSolidAngles) {
  for (const double h : {1.0, 1e-1, 1e-2, 1e-3, 1e-4}) {
    const auto rectangle =
        SphericalRectangle::seen_from({0, 0, 0}, {-h, -h, 1}, {2 * h, 0, 0}, {0, 2 * h, 0});
    ASSERT_TRUE(rectangle);
    const double truth = 4 * std::asin(h * h / (h * h + 1));
    EXPECT_NEAR(rectangle->solid_angle() / truth, 1, 1e-11) << h;
  }
  // The expected solid angle of a small rectangle off to the side is its area times the cosine,
  // divided by the squared distance. The squared distance is 10, and the cosine is 1 / sqrt(10). An
  // exact formula would subtract nearly equal numbers.
  const double h = 1e-4;
  const auto aside =
      SphericalRectangle::seen_from({0, 0, 0}, {3 - h, -h, 1}, {2 * h, 0, 0}, {0, 2 * h, 0});
  ASSERT_TRUE(aside);
  EXPECT_NEAR(aside->solid_angle() / (4 * h * h / std::pow(10, 1.5)), 1, 1e-7);
}

TEST(SphericalRectangle, L6_CornersOfTheUnitSquareStayInside) {
  for (const View& view : views()) {
    const auto rectangle =
        SphericalRectangle::seen_from(view.point, view.quad.corner, view.quad.u, view.quad.v);
    ASSERT_TRUE(rectangle);
    for (const double u : {0.0, 0x1p-32, 0.5, 1 - 0x1p-32}) {
      for (const double v : {0.0, 0x1p-32, 0.5, 1 - 0x1p-32}) {
        const Vec2 at = rectangle->sample(u, v);
        EXPECT_TRUE(at.x >= 0 && at.x <= 1 && at.y >= 0 && at.y <= 1) << u << " " << v;
      }
    }
  }
  test::report_hard_case("L6",
                         "80 samples at corners, edges and the middle lie inside the rectangle");
}

TEST(SphericalRectangle, IsAbsentForEdgeOnOrTinyRectangles) {
  // The rectangles are seen edge-on, from very far away, and from a corner.
  EXPECT_FALSE(SphericalRectangle::seen_from({0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(SphericalRectangle::seen_from({0, 0, 0}, {0, 0, 1e6}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_FALSE(SphericalRectangle::seen_from({0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}));
  EXPECT_TRUE(is_rectangle({1, 1, 0}, {0, 0, 5}));
  EXPECT_FALSE(is_rectangle({1, 0, 0}, {1e-3, 1, 0}));
}

TEST(SphereLight, SamplesUniformlyInSolidAngle) {
  const Vec3 center = {1, 2, 3};
  std::uint64_t seed = 20;
  for (const double distance : {1.05, 2.0, 10.0}) {
    const Vec3 point = center + distance * normalize(Vec3{1, -2, 0.5});
    test::expect_samples_match_density(
        [&](double u, double v) {
          const auto s = sample_sphere_light(center, 1, point, u, v);
          EXPECT_TRUE(s);
          EXPECT_NEAR(length(s->position - center), 1, 1e-14);
          EXPECT_LE(dot(s->normal, s->position - point), 1e-7);  // on the near side
          EXPECT_EQ(s->pdf, sphere_light_pdf(center, 1, point, s->position, s->normal));
          const Vec3 far_side = 2 * center - s->position;
          EXPECT_EQ(sphere_light_pdf(center, 1, point, far_side, -s->normal), 0);
          return normalize(s->position - point);
        },
        [&](const Vec3& d) {
          const Vec3 axis = normalize(center - point);
          const double spread = one_minus_cos_from_sin2(1 / (distance * distance));
          return 1 - dot(d, axis) <= spread * (1 + 1e-9) ? cone_pdf(spread) : 0;
        },
        ++seed);
  }
}

// If the point is inside the sphere, the mean of 1 / pdf is 4 pi, the solid angle of all
// directions.
TEST(SphereLight, L3_CoversAllDirectionsFromInside) {
  test::Random random(30);
  for (const double radius_of_point : {0.0, 0.5, 0.99}) {
    test::Moments directions;
    const Vec3 point = {radius_of_point, 0, 0};
    for (int i = 0; i < 100000; ++i) {
      const double u = random.uniform();
      const auto s = sample_sphere_light({0, 0, 0}, 1, point, u, random.uniform());
      ASSERT_TRUE(s);
      directions.add(1 / s->pdf);
    }
    EXPECT_LT(std::abs(directions.mean() / (4 * kPi) - 1),
              4 * directions.standard_error() / (4 * kPi) + 1e-12);
  }
  test::report_hard_case("L3", "receiver inside: the mean of 1 / pdf is 4 pi");
}

TEST(SphereLight, L3_HasNoNanOnItsSurface) {
  test::Random random(31);
  for (int i = 0; i < 10000; ++i) {
    const Vec3 point = test::random_direction(random) * random.uniform(1 - 1e-12, 1 + 1e-5);
    const double u = random.uniform();
    const auto s = sample_sphere_light({0, 0, 0}, 1, point, u, random.uniform());
    if (s) {
      EXPECT_TRUE(std::isfinite(s->pdf) && s->pdf > 0);
      EXPECT_TRUE(is_finite(s->position));
    }
  }
  test::report_hard_case("L3", "receiver on the surface: no NaN in 10,000 samples");
}

}  // namespace
}  // namespace bandsaw
