// Compares the irradiance under lights with closed forms. A measured value may differ by at most 4
// standard errors, and the standard error may be at most 1e-3 of the value. The standard error is
// that of the mean over 32 seeds. So each comparison of a correct renderer fails with a probability
// of about 1 / 2 700 when the random numbers change. An id such as L4 in a test's name is that of a
// case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Adds a white diffuse patch at the origin with normal +y, and expects that its irradiance, pi
/// times its radiance, is `expected`.
void expect_irradiance(SceneMaker maker, double expected, std::uint64_t samples = 1024) {
  maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}};
  const Moments radiance = test::radiance_along(*scene, down, {.max_depth = 1}, samples);
  const double value = expected / kPi;
  // Colours are floats: without noise they are accurate to a millionth.
  EXPECT_NEAR(radiance.mean(), value, 4 * radiance.standard_error() + 1e-6 * value)
      << "is " << radiance.mean() * kPi << ", expected " << expected;
  EXPECT_LE(radiance.standard_error(), 1e-3 * value);
}

/// Returns the center of a light at distance d, at `angle` from the normal.
Vec3 at(double d, double angle) { return {d * std::sin(angle), d * std::cos(angle), 0}; }

// The irradiance is pi (radius / d)^2 cos(angle).
TEST(DirectLight, OfASphereAboveTheHorizonMeetsTheClosedForm) {
  const auto sphere = [](double d, double angle, double radius) {
    SceneMaker maker;
    maker.sphere(at(d, angle), radius, maker.lamp(1));
    return maker;
  };
  expect_irradiance(sphere(2, 0, 1), 0.785398163397448);
  expect_irradiance(sphere(3, kPi / 3, 1), 0.174532925199433);
  expect_irradiance(sphere(1000, 1, 0.01), kPi * 1e-10 * std::cos(1.0));
}

TEST(DirectLight, L4_OfASphereThatCrossesTheHorizonMeetsTheIntegral) {
  // The irradiance is the integral of the cosine over the part of the sphere's cone that is above
  // the horizon.
  struct Row {
    double half_angle;  ///< of the cone in which the sphere is seen
    double tilt;        ///< of the cone's axis from the normal
    double irradiance;
  };
  for (const Row& row : {Row{0.5, 1.2, 0.26481523}, Row{0.5, 1.9, 0.00623511},
                         Row{1, 1.5707, 0.545458}, Row{0.2, 1.45, 0.01551167}}) {
    SceneMaker maker;
    maker.sphere(at(1, row.tilt), std::sin(row.half_angle), maker.lamp(1));
    expect_irradiance(maker, row.irradiance, 4096);
  }
  test::report_hard_case("L4", "irradiance within 4 SE of the integral");
}

TEST(DirectLight, L3_InsideASphereIsPi) {
  SceneMaker maker;
  maker.sphere({0.2, 0.1, 0}, 1, maker.lamp(1));
  expect_irradiance(maker, kPi);
  test::report_hard_case("L3", "receiver inside: E within 4 SE of pi L");
}

// The values are those of Lambert's formula for polygons (polygon_light_test.cpp).
TEST(DirectLight, OfASquareAboveTheReceiverMeetsTheClosedForm) {
  const auto square = [](double h, double shift) {
    SceneMaker maker;
    maker.quad({-1 + shift, h, -1 + shift}, {2, 0, 0}, {0, 0, 2}, maker.lamp(1));
    return maker;
  };
  expect_irradiance(square(0.1, 0), 3.116100618403);
  expect_irradiance(square(1, 0), 1.740839502734);
  expect_irradiance(square(5, 0), 0.151918069683);
  expect_irradiance(square(1, 1), 0.652688257754);
}

/// A square of side 2 at height 1 is made in three ways: as two triangles that are in no mesh, as a
/// mesh of two triangles with a mirrored and scaled placement, and as a mesh of 128 triangles that
/// is scaled by 100. Each way gives the irradiance of a quad of this size at this height.
TEST(DirectLight, ASquareGivesTheSameIrradianceAsQuadTrianglesOrMesh) {
  const double expected = 1.740839502734;  // as of the quad in the previous test
  SceneMaker triangles;
  const MaterialId lamp = triangles.lamp(1);
  triangles.triangle({-1, 1, -1}, {1, 1, -1}, {1, 1, 1}, lamp);
  triangles.triangle({-1, 1, -1}, {1, 1, 1}, {-1, 1, 1}, lamp);
  expect_irradiance(triangles, expected, 8192);

  SceneMaker mesh;
  mesh.instance(test::grid(1),
                translation({0, 1, 0}) * rotation({1, 0, 0}, 90) * scaling({-1, 1, 3}),
                mesh.lamp(1));
  expect_irradiance(mesh, expected, 8192);

  SceneMaker many;
  Mesh small = test::grid(8);
  for (auto& position : small.positions) {
    position = {position[0] / 100, position[1] / 100, 0};
  }
  many.instance(small, translation({0, 1, 0}) * rotation({1, 0, 0}, 90) * scaling({100, 100, 1}),
                many.lamp(1));
  expect_irradiance(many, expected, 8192);
}

TEST(DirectLight, OfAOneSidedSquareIsZeroOnItsBack) {
  for (const bool front : {true, false}) {
    SceneMaker maker;
    const Vec3 u{2, 0, 0};
    const Vec3 v{0, 0, 2};
    maker.quad({-1, 1, -1}, front ? u : v, front ? v : u, maker.lamp(1, true));
    expect_irradiance(maker, front ? 1.740839502734 : 0);
  }
}

TEST(DirectLight, OfTwoLightsAddsUp) {
  SceneMaker maker;
  maker.sphere(at(3, -kPi / 3), 1, maker.lamp(2));
  maker.quad({-1, 5, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(3));
  expect_irradiance(maker, 2 * 0.174532925199433 + 3 * 0.151918069683, 4096);
}

TEST(DirectLight, OfManyLightsAddsUp) {
  SceneMaker maker;
  double expected = 0;
  for (int i = 0; i < 40; ++i) {
    const double angle = 0.2 + 0.15 * (i % 8);
    const double distance = 3 + 0.2 * i;
    const auto power = static_cast<float>(1 + i % 5);
    const double turn = i * 2.4;
    const Vec3 flat = at(distance, angle);
    maker.sphere({flat.x * std::cos(turn), flat.y, flat.x * std::sin(turn)}, 0.05,
                 maker.lamp(power));
    expected += power * kPi * 0.0025 / (distance * distance) * std::cos(angle);
  }
  expect_irradiance(maker, expected, 4096);
}

}  // namespace
}  // namespace bandsaw
