// Compares the light of hidden lamps with closed forms, within 4 standard errors over 32 seeds. The
// camera does not see a hidden lamp (Emissive::hidden), and the lamp stops no light. After a
// correct change of the sampling, a test fails with a probability of about 1 / 2 700.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Adds the material of a hidden lamp that emits to one side, and returns its id.
MaterialId hidden_lamp(SceneMaker& maker, float radiance) {
  const MaterialId id = maker.lamp(radiance, /*one_sided=*/true);
  std::get<Emissive>(maker.scene.materials[index_of(id)].kind).hidden = true;
  return id;
}

/// A square of side 2 at height 1, which emits downwards.
void add_square(SceneMaker& maker, MaterialId material) {
  maker.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, material);
}

/// Irradiance at the origin with normal +y under the square of add_square(), if its radiance is 1.
constexpr double kOfSquare = 1.740839502734;

/// Adds a white diffuse patch around the origin and expects its irradiance.
void expect_irradiance(SceneMaker maker, double expected) {
  maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}};
  const Moments radiance = test::radiance_along(*scene, down, {.max_depth = 1}, 4096);
  const double value = expected / kPi;
  EXPECT_NEAR(radiance.mean(), value, 4 * radiance.standard_error() + 1e-6 * value)
      << "is " << radiance.mean() * kPi << ", expected " << expected;
  EXPECT_LE(radiance.standard_error(), 0.01 * value);
}

TEST(HiddenLamp, LightsASurfaceLikeAVisibleLamp) {
  SceneMaker maker;
  add_square(maker, hidden_lamp(maker, 1));
  expect_irradiance(maker, kOfSquare);
}

TEST(HiddenLamp, StopsNoLightOfTheSkyOrOfOtherLamps) {
  SceneMaker maker;
  add_square(maker, hidden_lamp(maker, 1));
  // A square of twice the size at twice the distance gives the same irradiance per radiance. The
  // two squares have the radiances 1 and 2, so together they give 3 times kOfSquare.
  maker.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, hidden_lamp(maker, 2));
  maker.background({0.5F, 0.5F, 0.5F}, {0.5F, 0.5F, 0.5F});
  expect_irradiance(maker, 3 * kOfSquare + 0.5 * kPi);
}

TEST(HiddenLamp, EmitsToOneSide) {
  SceneMaker maker;
  maker.quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}, hidden_lamp(maker, 1));  // emits upwards
  maker.background({1, 1, 1}, {1, 1, 1});
  expect_irradiance(maker, kPi);
}

TEST(HiddenLamp, TheCameraSeesThroughIt) {
  SceneMaker maker;
  add_square(maker, hidden_lamp(maker, 1));
  maker.background({0.25F, 0.25F, 0.25F}, {0.25F, 0.25F, 0.25F});
  const auto scene = maker.build();
  for (const double up : {1.0, -1.0}) {
    const Ray ray{.origin = {0, 1 - up, 0}, .direction = {0, up, 0}};
    EXPECT_EQ(test::radiance_along(*scene, ray, {.max_depth = 4}, 16).mean(), 0.25);
  }
}

// Mirrors show the emitting side of a hidden lamp, and the light from behind the lamp.
TEST(HiddenLamp, IsSeenInAMirror) {
  SceneMaker maker;
  add_square(maker, hidden_lamp(maker, 1));
  maker.background({0.25F, 0.25F, 0.25F}, {0.25F, 0.25F, 0.25F});
  maker.quad({-0.5, 0, -0.5}, {0, 0, 1}, {1, 0, 0}, maker.metal(1, 0));
  const auto scene = maker.build();
  const Ray down{.origin = {0, 3, 0}, .direction = {0, -1, 0}};
  EXPECT_NEAR(test::radiance_along(*scene, down, {.max_depth = 4}, 16).mean(), 1.25, 1e-6);
}

}  // namespace
}  // namespace bandsaw
