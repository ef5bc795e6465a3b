// Mixtures of materials, height maps, sheets (surfaces that transmit diffusely) and emission of
// surfaces that also scatter, in whole scenes.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/integrate/path.h"
#include "renderlib/integrate/sample_value.h"
#include "renderlib/material/mixture.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"
#include "tests/unit/integrate/techniques.h"

namespace bandsaw {
namespace {

using test::expect_techniques_agree;
using test::light_along;
using test::Moments;
using test::SceneMaker;

/// Half the width of large floors and sheets.
constexpr double kFar = 100;

/// Returns a maker with a sky of this radiance. Texture 0 is white, so that factors alone define a
/// material.
SceneMaker with_sky(float radiance) {
  SceneMaker maker;
  maker.texture(ConstantTexture{{1, 1, 1}});
  maker.background(gray(radiance), gray(radiance));
  return maker;
}

const Ray kAhead{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};

/// Adds a wall in the plane z = 0.
void wall(SceneMaker& maker, MaterialId material) {
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, material);
}

TEST(Mixture, ShowsEachPartWithItsProbability) {
  SceneMaker maker = with_sky(1);
  const MaterialId black = maker.diffuse(0.0f);
  const MaterialId gray = maker.diffuse(0.5f);
  const TextureId quarter = maker.texture(ConstantTexture{{0.25f, 0.25f, 0.25f}});
  const MaterialId inner = maker.material(Mix{black, gray, quarter});
  // The reflectance is 1/4 of (1/4 of 0.5) plus 3/4 of 0.5.
  wall(maker, maker.material(Mix{gray, inner, quarter}));
  const Moments sum = light_along(maker, kAhead, 20000);
  EXPECT_NEAR(sum.mean(), 0.75 * 0.5 + 0.25 * 0.125, 4 * sum.standard_error());
  const auto scene = maker.build();
  EXPECT_TRUE(scene->features().mixtures);
}

TEST(Mixture, WithHolesLetsLightThroughAndAllTechniquesAgree) {
  SceneMaker maker = with_sky(0);
  Material lattice = Diffuse{TextureId{0}};
  lattice.alpha = {AlphaMode::kBlend, {TextureId{0}, 0.25}};
  const MaterialId holes = maker.material(lattice);
  const TextureId half = maker.texture(ConstantTexture{{0.5f, 0.5f, 0.5f}});
  const MaterialId cover = maker.material(Mix{holes, maker.diffuse(0.2f), half});
  maker.quad({-kFar, 0, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, maker.diffuse(0.7f));
  maker.quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(5));
  maker.quad({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, cover);
  expect_techniques_agree(
      maker, {.origin = {0.3, 0.9, 0.4}, .direction = normalize({0.1, -1, 0.05})}, 0.1);
}

// One part emits and is partly transparent. Light sampling and BSDF sampling agree.
TEST(Mixture, WithAnEmittingPartIsALight) {
  SceneMaker maker = with_sky(0);
  Material glow = Diffuse{TextureId{0}};
  glow.emission.radiance = {TextureId{0}, {6, 6, 6}};
  glow.alpha = {AlphaMode::kBlend, {TextureId{0}, 0.5}};
  const MaterialId lit = maker.material(glow);
  const TextureId third = maker.texture(ConstantTexture{{0.3f, 0.3f, 0.3f}});
  maker.quad({-kFar, 0, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, maker.diffuse(0.5f));
  maker.sphere({0, 2, 0}, 0.7, maker.material(Mix{lit, maker.diffuse(0.1f), third}));
  EXPECT_EQ(maker.build()->lights().size(), 1u);
  expect_techniques_agree(maker, {.origin = {2, 3, 0}, .direction = normalize({-0.5, -1, 0})}, 0.1);
}

TEST(Mixture, AllowsPathReuseUnlessItHasHoles) {
  SceneMaker maker = with_sky(0);
  const TextureId half = maker.texture(ConstantTexture{{0.5f, 0.5f, 0.5f}});
  wall(maker, maker.material(Mix{maker.diffuse(0.2f), maker.diffuse(0.8f), half}));
  maker.sphere({0, 0, 2}, 0.2, maker.lamp(3));
  EXPECT_TRUE(maker.build()->reuses_paths());
  Material holes = Diffuse{TextureId{0}};
  holes.alpha = {AlphaMode::kBlend, {TextureId{0}, 0.5}};
  wall(maker, maker.material(Mix{maker.material(holes), maker.diffuse(0.8f), half}));
  EXPECT_FALSE(maker.build()->reuses_paths());
}

// There is a lamp on each side of the sheet, and lights are sampled on both sides.
TEST(Sheet, LightFromBehindIsFoundByAllTechniques) {
  SceneMaker maker = with_sky(0);
  const MaterialId sheet = maker.material(DiffuseTransmission{TextureId{0}, TextureId{0}});
  maker.quad({-kFar, -kFar, 0}, {2 * kFar, 0, 0}, {0, 2 * kFar, 0}, sheet);
  maker.sphere({0.5, 0, -2}, 0.3, maker.lamp(40));
  maker.sphere({-1, 0.5, 3}, 0.3, maker.lamp(20));
  expect_techniques_agree(maker, kAhead, 0.1);
  // The sheet transmits half of the light of a small lamp. If the lamp gives the sheet the
  // irradiance E, the radiance of the sheet is E / (2 pi).
  SceneMaker behind = with_sky(0);
  const MaterialId paper = behind.material(DiffuseTransmission{TextureId{0}, TextureId{0}});
  behind.quad({-kFar, -kFar, 0}, {2 * kFar, 0, 0}, {0, 2 * kFar, 0}, paper);
  behind.sphere({0.1, 0.2, -3}, 0.1, behind.lamp(100));
  const Moments sum = light_along(behind, kAhead, 500);
  const double irradiance = 100 * 3.14159265358979 * 0.01 / 9;
  EXPECT_NEAR(sum.mean(), irradiance / (2 * 3.14159265358979), 0.02 * sum.mean());
}

TEST(EmissionOfDiffuse, IsAddedToTheReflectionAndMakesALight) {
  SceneMaker maker = with_sky(1);
  Material glow = Diffuse{TextureId{0}};
  glow.emission = {{TextureId{0}, {3, 3, 3}}, true};
  const MaterialId lit = maker.material(glow);
  wall(maker, lit);
  EXPECT_NEAR(light_along(maker, kAhead, 100).mean(), 4, 1e-5);
  const Ray back{.origin = {0.1, 0.2, -5}, .direction = {0, 0, 1}};
  EXPECT_NEAR(light_along(maker, back, 100).mean(), 1, 1e-5);
  EXPECT_EQ(maker.build()->lights().size(), 1u);
}

/// Returns (n + 1) / 2, where n is the shading normal of the surface that the ray hits.
Rgb normal_at(const SceneMaker& maker, const Ray& ray) {
  PathCounts counts;
  return sample_value(*maker.build(), Integrator::kNormals, ray, PixelSampler(1, 0, 0), 0, {},
                      counts);
}

/// Returns a texture whose value is the coordinate `over`, for coordinates from 0 to 8.
TextureId coordinate(SceneMaker& maker, RampTexture::Over over) {
  RampTexture ramp;
  ramp.over = over;
  ramp.stops = {{0, {}}, {8, gray(8)}};
  return maker.texture(ramp);
}

// The height is the coordinate u or x times the scale. The wall is 2 units wide. Over this width, u
// rises by 1, so a height of u has half the scale as its slope. The coordinate x rises by 2, so a
// height of x has the scale as its slope.
TEST(HeightMap, TiltsTheNormalByItsSlope) {
  for (const double scale : {0.5, 1.0, -1.0}) {
    for (const bool in_space : {false, true}) {
      SceneMaker maker = with_sky(1);
      Material bumped = Diffuse{TextureId{0}};
      bumped.relief.height =
          coordinate(maker, in_space ? RampTexture::Over::kX : RampTexture::Over::kU);
      bumped.relief.height_scale = scale;
      const double left = in_space ? 0 : -1;  // the ramp by position begins at 0
      maker.quad({left, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(bumped));
      const Rgb n = normal_at(maker, {.origin = {0.4, 0.2, 5}, .direction = {0, 0, -1}});
      const double slope = in_space ? scale : scale / 2;
      EXPECT_NEAR(2.0 * n.r - 1, -slope / std::sqrt(1 + slope * slope), 2e-4);
      EXPECT_NEAR(2.0 * n.g - 1, 0, 2e-4);
    }
  }
}

// On a ball of radius 2, v rises by 1 along half of a great circle. On a disk of radius 2, u rises
// by 1 over the diameter. The height is 3 times the coordinate.
TEST(HeightMap, ConvertsUvsToLengthsOnBallsAndDisks) {
  SceneMaker ball = with_sky(1);
  Material bumped = Diffuse{TextureId{0}};
  bumped.relief.height = coordinate(ball, RampTexture::Over::kV);
  bumped.relief.height_scale = 3;
  ball.sphere({0, 0, 0}, 2, ball.material(bumped));
  const Rgb of_ball = normal_at(ball, {.origin = {0, 1e-9, 5}, .direction = {0, 0, -1}});
  const double slope = 3 / (3.14159265358979 * 2);
  EXPECT_NEAR(2.0 * of_ball.g - 1, -slope / std::sqrt(1 + slope * slope), 5e-4);
  SceneMaker disk = with_sky(1);
  bumped.relief.height = coordinate(disk, RampTexture::Over::kU);
  disk.scene.geometry.disks = {{{0, 0, 0}, {0, 0, 1}, 2, disk.material(bumped)}};
  const Rgb of_disk = normal_at(disk, {.origin = {0.3, 0.4, 5}, .direction = {0, 0, -1}});
  const double normal_z = 2.0 * of_disk.b - 1;
  EXPECT_NEAR(normal_z, 1 / std::sqrt(1 + 0.75 * 0.75), 5e-4);
}

}  // namespace
}  // namespace bandsaw
