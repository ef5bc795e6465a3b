// Maps from the unit square to disks, hemispheres, spheres, cones and balls. An id such as M1 in a
// test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/sampling/warp.h"

#include <gtest/gtest.h>

#include <vector>

#include "renderlib/math/elementary.h"
#include "renderlib/sampling/basis.h"
#include "tests/support/direction_test.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::expect_samples_match_density;

/// Coordinates at and near the edges of the unit square, and in its middle.
const std::vector<double> kCorners = {0, 0x1p-32, 0.5, 1 - 0x1p-24, 1 - 0x1p-32};

TEST(Warp, DiskIsUniform) {
  std::vector<std::uint64_t> counts(64);
  test::Random random(1);
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    const Vec2 p = sample_disk(u, random.uniform());
    const double r2 = p.x * p.x + p.y * p.y;
    ASSERT_LE(r2, 1 + 1e-15);
    const double turn = atan2(p.y, p.x) / (2 * kPi) + 0.5;
    ++counts[std::min<std::size_t>(7, static_cast<std::size_t>(r2 * 8)) * 8 +
             std::min<std::size_t>(7, static_cast<std::size_t>(turn * 8))];
  }
  EXPECT_GT(test::chi_squared(counts, std::vector<double>(64, 100000.0 / 64)).p_value, 0.01);
}

// sample_cone(1, v, 1) is a point on the rim of a hemisphere, at v turns. sample_disk is the
// concentric map (Shirley and Chiu 1997), which maps squares around the middle to circles.
TEST(Warp, PointsMatchExactAngles) {
  test::Random random(8);
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    const double v = random.uniform();
    const SinCos around = sincos_turns(v);
    const Vec3 on_equator = sample_cone(1, v, 1);
    ASSERT_NEAR(on_equator.x, around.cos, 0x1p-51);
    ASSERT_NEAR(on_equator.y, around.sin, 0x1p-51);
    const Vec2 p = sample_disk(u, v);
    const double radius = std::max(std::abs(2 * u - 1), std::abs(2 * v - 1));
    ASSERT_NEAR(p.x * p.x + p.y * p.y, radius * radius, 0x1p-51);
    const bool wide = std::abs(2 * u - 1) > std::abs(2 * v - 1);
    const double turn = wide ? (2 * v - 1) / (2 * u - 1) / 8 : 0.25 - (2 * u - 1) / (2 * v - 1) / 8;
    ASSERT_NEAR(p.x * sincos_turns(turn).sin, p.y * sincos_turns(turn).cos, 0x1p-51);
  }
  for (const double quarter : {0.0, 0.25, 0.5, 0.75}) {
    const Vec3 axis = sample_cone(1, quarter, 1);
    EXPECT_EQ(axis.x, sincos_turns(quarter).cos);
    EXPECT_EQ(axis.y, sincos_turns(quarter).sin);
  }
}

TEST(Warp, CosineHemisphereMatchesItsPdf) {
  expect_samples_match_density([](double u, double v) { return sample_cosine_hemisphere(u, v); },
                               [](const Vec3& d) { return cosine_hemisphere_pdf(d.z); }, 2);
}

TEST(Warp, SphereMatchesItsPdf) {
  expect_samples_match_density([](double u, double v) { return sample_sphere(u, v); },
                               [](const Vec3&) { return kSpherePdf; }, 3);
}

// The spread of a cone is 1 - cos of the angle between its axis and its rim.
TEST(Warp, ConeMatchesItsPdf) {
  const double spread = 0.4;
  expect_samples_match_density(
      [=](double u, double v) { return sample_cone(u, v, spread); },
      [=](const Vec3& d) { return 1 - d.z < spread ? cone_pdf(spread) : 0; }, 4);
}

TEST(Warp, BallIsUniform) {
  test::Random random(5);
  test::Moments inside;  // share of points within half of the radius: an eighth of the volume
  test::Moments mean_x;
  for (int i = 0; i < 100000; ++i) {
    const double u = random.uniform();
    const double v = random.uniform();
    const Vec3 p = sample_ball(u, v, random.uniform());
    ASSERT_LE(length(p), 1 + 1e-15);
    inside.add(length(p) < 0.5 ? 1 : 0);
    mean_x.add(p.x);
  }
  EXPECT_LT(std::abs(inside.z(0.125)), 4);
  EXPECT_LT(std::abs(mean_x.z(0)), 4);
  EXPECT_NEAR(mean_x.variance(), 0.2, 0.005);  // the mean of x^2 in a unit ball is 1 / 5
}

TEST(Warp, M1_CornersOfTheUnitSquareGiveValidPoints) {
  for (const double u : kCorners) {
    for (const double v : kCorners) {
      const Vec3 d = sample_cosine_hemisphere(u, v);
      EXPECT_NEAR(length(d), 1, 1e-15);
      EXPECT_GT(d.z, 0);
      EXPECT_NEAR(length(sample_sphere(u, v)), 1, 1e-15);
      EXPECT_NEAR(length(sample_cone(u, v, 1e-9)), 1, 1e-15);
      EXPECT_TRUE(is_finite(sample_ball(u, v, u)));
    }
  }
}

TEST(Warp, NarrowConesKeepTheirWidth) {
  for (const double sine : {1e-2, 1e-4, 1e-7}) {
    const double spread = one_minus_cos_from_sin2(sine * sine);
    EXPECT_NEAR(spread / (0.5 * sine * sine), 1, sine * sine);
    const Vec3 rim = sample_cone(1 - 0x1p-32, 0, spread);
    EXPECT_NEAR(rim.x / sine, 1, 1e-9);
  }
}

TEST(Warp, M15_BasisIsOrthonormalInEveryDirection) {
  test::Random random(6);
  std::vector<Vec3> normals = {{0, 0, 1},       {0, 0, -1},    {1, 0, 0},
                               {0, -1, 0},      {1e-9, 0, -1}, normalize(Vec3{1e-5, 1e-5, -1}),
                               {0, 0, -0.0 - 1}};
  for (int i = 0; i < 10000; ++i) {
    normals.push_back(test::random_direction(random));
  }
  for (const Vec3& n : normals) {
    const Basis b = orthonormal_basis(n);
    EXPECT_NEAR(dot(b.x, b.y), 0, 1e-15);
    EXPECT_NEAR(dot(b.x, n), 0, 1e-15);
    EXPECT_NEAR(dot(b.y, n), 0, 1e-15);
    EXPECT_NEAR(length(b.x), 1, 1e-15);
    EXPECT_NEAR(length(b.y), 1, 1e-15);
    EXPECT_NEAR(dot(cross(b.x, b.y), n), 1, 1e-14);
    EXPECT_LE(length(b.to_local(b.to_world({0.1, 0.2, 0.3})) - Vec3{0.1, 0.2, 0.3}), 1e-15);
  }
  test::report_hard_case("M15", "10,007 bases are orthonormal within 1e-15");
}

}  // namespace
}  // namespace bandsaw
