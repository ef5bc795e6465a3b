// Tests alpha, nested glass and glTF's material along whole paths. Where nested glasses overlap,
// only the glass of the highest priority is present. An id such as M6 in a test's name is that of a
// case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/path.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/interiors.h"
#include "tests/support/hard_case.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"
#include "tests/unit/integrate/techniques.h"

namespace bandsaw {
namespace {

using test::expect_techniques_agree;
using test::light_along;
using test::Moments;
using test::SceneMaker;

/// Half the width of large floors and slabs.
constexpr double kFar = 100;

/// A material with a black base colour, which reflects only a little light.
MetallicRoughness black() {
  MetallicRoughness m;
  m.base_color.factor = {0, 0, 0};
  m.roughness.factor = 1;
  return m;
}

/// A black surface that is present with the probability `alpha`.
Material blended(double alpha) {
  Material m = black();
  m.alpha.mode = AlphaMode::kBlend;
  m.alpha.value.factor = alpha;
  return m;
}

/// Returns a maker with a sky of radiance 1. Texture 0 is white, so that factors alone define a
/// material.
SceneMaker white_sky() {
  SceneMaker maker;
  maker.scene.textures.insert(maker.scene.textures.begin(), ConstantTexture{{1, 1, 1}});
  maker.background({1, 1, 1}, {1, 1, 1});
  return maker;
}

TEST(Alpha, CoplanarBlendedSurfacesAreHitOneAfterTheOther) {
  for (const int layers : {1, 2, 5}) {
    SceneMaker maker = white_sky();
    const MaterialId faint = maker.material(blended(0.25));
    for (int i = 0; i < layers; ++i) {
      maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, faint);
      maker.triangle({-9, -9, 0}, {9, -9, 0}, {0, 9, 0}, faint);
    }
    const Ray ray{.origin = {0.1, 0.2, 3}, .direction = {0, 0, -1}};
    // The path sees black if a surface is present, except for the reflection at the surface.
    const double through = std::pow(0.75, 2 * layers);
    const Moments sum = light_along(maker, ray, 20000);
    EXPECT_NEAR(sum.mean(), through, 0.045 * (1 - through) + 4 * sum.standard_error());
    EXPECT_GT(sum.mean(), through - 4 * sum.standard_error());
  }
}

TEST(Alpha, BothSidesOfASphereAreHit) {
  SceneMaker maker = white_sky();
  const MaterialId half = maker.material(blended(0.5));
  maker.sphere({0, 0, 0}, 1, half);
  maker.sphere({0, 0, 0.3}, 1, half);
  // The ray meets four surfaces and passes each with probability 1/2. A surface that is present is
  // black, except for its reflection.
  const Moments sum = light_along(maker, {.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}}, 20000);
  EXPECT_NEAR(sum.mean(), 0.0625, 0.045 + 4 * sum.standard_error());
  EXPECT_GT(sum.mean(), 0.0625 - 4 * sum.standard_error());
}

TEST(Alpha, AMaskedSurfaceIsPresentOrAbsent) {
  for (const double cutoff : {0.4, 0.6}) {
    SceneMaker maker = white_sky();
    Material mask = blended(0.5);
    mask.alpha.mode = AlphaMode::kMask;
    mask.alpha.cutoff = cutoff;
    maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(mask));
    const Moments sum =
        light_along(maker, {.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}}, 2000);
    EXPECT_NEAR(sum.mean(), cutoff > 0.5 ? 1 : 0, 0.07);
  }
}

TEST(Alpha, AttenuatesShadowRaysAndAllTechniquesAgree) {
  SceneMaker maker;
  maker.scene.textures.insert(maker.scene.textures.begin(), ConstantTexture{{1, 1, 1}});
  maker.background({0, 0, 0}, {0, 0, 0});
  MetallicRoughness floor;
  floor.roughness.factor = 0.6;
  floor.base_color.factor = {0.7f, 0.7f, 0.7f};
  maker.quad({-kFar, 0, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, maker.material(floor));
  maker.quad({-1, 3, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(5));
  maker.quad({-4, 1, -4}, {8, 0, 0}, {0, 0, 8}, maker.material(blended(0.5)));
  const Ray ray{.origin = {0.3, 0.9, 0.4}, .direction = normalize({0.1, -1, 0.05})};
  expect_techniques_agree(maker, ray, 0.1);
}

// Each side of the ball is present with probability 1/2. The far side is seen only if the near side
// is absent, so it contributes a third of the light.
TEST(Alpha, ATransparentLightEmitsFromBothSides) {
  SceneMaker maker;
  maker.scene.textures.insert(maker.scene.textures.begin(), ConstantTexture{{1, 1, 1}});
  maker.background({0, 0, 0}, {0, 0, 0});
  maker.quad({-kFar, 0, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, maker.diffuse(0.5f));
  Material lamp = blended(0.5);
  lamp.emission.radiance.factor = {4, 4, 4};
  maker.sphere({0, 2, 0}, 0.7, maker.material(lamp));
  expect_techniques_agree(maker, {.origin = {2, 3, 0}, .direction = normalize({-0.5, -1, 0})}, 0.1);
}

// A ball of index 1, rough or not, is between two lights (an area light and a delta light) and a
// floor. The radiance has the same bits as without the ball.
TEST(SeeThrough, M6_GlassOfIndexOneCastsNoShadow) {
  const auto light = [](std::optional<double> roughness) {
    SceneMaker maker;
    maker.quad({-kFar, 0, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, maker.diffuse(0.5f));
    maker.sphere({0.5, 3, 0}, 0.2, maker.lamp(9));
    maker.scene.lights = {PointLight{{-0.5, 3, 0}, gray(4)}};
    if (roughness) {
      maker.sphere({0, 1, 0}, 0.8, maker.material(Dielectric{1 + 1e-7, *roughness}));
    }
    const Ray ray{.origin = {0, 1, 5}, .direction = normalize({0, -0.2, -1})};
    return light_along(maker, ray, 256).mean();
  };
  const double alone = light(std::nullopt);
  EXPECT_GT(alone, 0);
  EXPECT_EQ(light(0), alone);
  EXPECT_EQ(light(0.5), alone);
  test::report_hard_case(
      "M6", "a glass ball of index 1 + 1e-7 in front of lamps changes no bit of the radiance");
}

TEST(Emission, OfAScatteringSurfaceIsAddedToItsReflection) {
  SceneMaker maker = white_sky();
  Material glow = black();
  glow.emission = {{{}, {3, 3, 3}}, true};
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(glow));
  const Ray front{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};
  // The black surface emits 3 and reflects a little of the sky.
  EXPECT_NEAR(light_along(maker, front, 2000).mean(), 3.02, 0.03);
  const Ray back{.origin = {0.1, 0.2, -5}, .direction = {0, 0, 1}};
  EXPECT_LT(light_along(maker, back, 2000).mean(), 0.1);
}

// A full coat reflects 0.04 of the light at 0 degrees from the normal, and 0.04 + 0.96 / 32 = 0.07
// at 60 degrees.
TEST(Emission, IsAttenuatedByTheClearCoat) {
  SceneMaker maker = white_sky();
  maker.background({0, 0, 0}, {0, 0, 0});
  MetallicRoughness coated;
  coated.base_color.factor = {0, 0, 0};
  coated.coat.factor = 0.5;
  Material glow = coated;
  glow.emission.radiance.factor = {3, 3, 3};
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(glow));
  const Ray ahead{.origin = {0, 0, 5}, .direction = {0, 0, -1}};
  EXPECT_NEAR(light_along(maker, ahead, 10).mean(), 3 * (1 - 0.5 * 0.04), 1e-6);
  const Vec3 slanted{std::sqrt(0.75), 0, -0.5};
  const Ray aside{.origin = slanted * -4, .direction = slanted};
  EXPECT_NEAR(light_along(maker, aside, 10).mean(), 3 * (1 - 0.5 * 0.07), 1e-6);
}

// Only light sampling reaches a delta light behind a rough pane. The transmitted light is given by
// the value of the BSDF of the pane.
TEST(SeeThrough, DeltaLightsAreVisibleThroughRoughTransmission) {
  MetallicRoughness paper;
  paper.roughness.factor = 0.7;
  paper.transmission.factor = 1;
  for (const Material& material : {Material(paper), Material(Dielectric{1.5, 0.5})}) {
    SceneMaker maker = white_sky();
    maker.background({0, 0, 0}, {0, 0, 0});
    maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.material(material));
    maker.scene.lights = {PointLight{{0.3, 0.1, -2}, gray(4)}};
    const Ray ray{.origin = {0, 0, 3}, .direction = {0, 0, -1}};
    const auto scene = maker.build();
    std::uint64_t rays = 0;
    NestedDielectrics nesting;
    const auto point = intersect_visible(*scene, ray, PixelSampler(5, 0, 3), 0, 0, nesting, rays);
    ASSERT_TRUE(point);
    const Bsdf bsdf =
        bsdf_at(scene->material(point->material), scene->textures(), *point, -ray.direction);
    const Vec3 to_light = Vec3{0.3, 0.1, -2};
    const double expected =
        evaluate(bsdf, normalize(to_light)).value.g * 4 / length_squared(to_light);
    EXPECT_GT(expected, 0.01);
    const Moments seen = light_along(maker, ray, 64);
    EXPECT_NEAR(seen.mean(), expected, 1e-6 * expected);
  }
}

TEST(NestedGlass, M9_TheHigherPriorityRefractsInOverlaps) {
  // Water (priority 1) overlaps its tumbler (priority 2). Each is a slab, and they overlap by
  // `overlap`.
  const auto stack = [](double overlap) {
    SceneMaker maker = white_sky();
    const MaterialId water = maker.material(Dielectric{1.33, 0, 1});
    const MaterialId glass = maker.material(Dielectric{1.5, 0, 2});
    const auto slab = [&](double low, double high, MaterialId material) {
      maker.quad({-kFar, high, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, material);
      maker.quad({-kFar, low, -kFar}, {2 * kFar, 0, 0}, {0, 0, 2 * kFar}, material);
    };
    slab(1 - overlap, 2, water);
    slab(0, 1, glass);
    // Only a narrow strip emits. The refracted ray meets this strip.
    maker.background({0, 0, 0}, {0, 0, 0});
    const double sine = std::sqrt(0.5);
    const double tan_water = (sine / 1.33) / std::sqrt(1 - sine * sine / 1.33 / 1.33);
    const double tan_glass = (sine / 1.5) / std::sqrt(1 - sine * sine / 2.25);
    const double x = tan_water + tan_glass + 1;
    maker.quad({x - 1e-6, -1, -1}, {2e-6, 0, 0}, {0, 0, 2}, maker.lamp(1));
    const Ray ray{.origin = {-1, 3, 0}, .direction = normalize({1, -1, 0})};
    return light_along(maker, ray, 20000).mean();
  };
  // The radiance of the strip is 1. The faces of the slabs reflect a part of it.
  const double at_most = 1;
  const double overlapping = stack(0.1);
  EXPECT_GT(overlapping, 0.85);
  EXPECT_LE(overlapping, at_most);
  EXPECT_NEAR(stack(0.5), overlapping, 0.02);
  test::report_hard_case(
      "M9", "overlapping glass: rays are refracted only by the glass of the higher priority");
}

// Interiors is the set of glasses that contain a point of a path. The air has a higher priority
// than the glass. So the boundary of the bubble refracts from the index 1.5 to 1, and a boundary of
// the glass inside the bubble is hidden.
TEST(NestedGlass, M9_AnAirBubbleInGlassRefractsOutwards) {
  Interiors inside;
  const Dielectric glass{1.5, 0, 1};
  const Dielectric air{1, 0, 2};
  EXPECT_EQ(inside.index_without(MaterialId{0}), 1);
  inside.pass(MaterialId{0}, glass, true);
  EXPECT_FALSE(inside.hides(MaterialId{1}, air, true));
  EXPECT_EQ(inside.index_without(MaterialId{1}), 1.5);
  inside.pass(MaterialId{1}, air, true);
  EXPECT_TRUE(inside.hides(MaterialId{0}, glass, false));
  inside.pass(MaterialId{1}, air, false);
  inside.pass(MaterialId{0}, glass, false);
  EXPECT_EQ(inside.index_without(MaterialId{1}), 1);
  test::report_hard_case("M9", "bubble of air in glass: the correct index on both sides");
}

// Walls inside three overlapping bodies of one glass are not present. A ray along the axis passes
// the bodies as it would pass one pane, which transmits 0.96 / 1.04 of the light.
TEST(NestedGlass, OverlappingBodiesOfOneGlassAreOne) {
  SceneMaker maker = white_sky();
  maker.background({0, 0, 0}, {0, 0, 0});
  const MaterialId glass = maker.material(Dielectric{1.5, 0, 1});
  for (const double z : {0.0, 1.0, -0.7}) {
    maker.sphere({0, 0, z}, 1, glass);
  }
  maker.quad({-9, -9, -9}, {18, 0, 0}, {0, 18, 0}, maker.lamp(1));
  const Moments seen = light_along(maker, {.origin = {0, 0, 5}, .direction = {0, 0, -1}}, 40000);
  EXPECT_NEAR(seen.mean(), 0.96 / 1.04, 4 * seen.standard_error());
  EXPECT_LE(seen.standard_error(), 0.002);
}

// A bubble extends out of a block of glass. The part of the block's face inside the bubble is not
// present for paths, but occludes shadow rays. So light behind this part is found by BSDF sampling
// alone.
TEST(NestedGlass, EmissionBehindAHiddenBoundaryCounts) {
  SceneMaker maker = white_sky();
  maker.background({0, 0, 0}, {0, 0, 0});
  maker.sphere({0, 0, 0}, 2, maker.material(Dielectric{1.5, 0, 1}));
  maker.sphere({0, 0, 2}, 1, maker.material(Dielectric{1.2, 0, 2}));
  maker.quad({-0.3, -0.3, 1.3}, {0, 0.6, 0}, {0, 0, 1.3}, maker.diffuse(0.8f));
  maker.sphere({0.3, 0, 1.5}, 0.15, maker.lamp(10));
  const Ray ray{.origin = {2.7, 0, 5.4}, .direction = normalize({-1, 0, -1})};
  expect_techniques_agree(maker, ray, 0.05);
}

// Milk is in a tumbler of glass (priority 2), and water (priority 1) overlaps the tumbler's wall.
// All are without loss, under a sky of radiance 1, so the radiance must be 1. A path that scatters
// before the hidden boundary of the water has not passed this boundary.
TEST(NestedGlass, ScatteringBeforeAHiddenBoundaryIsStillInTheGlass) {
  SceneMaker maker = white_sky();
  maker.sphere({0, 0, 0}, 1, maker.material(Dielectric{1.5, 0, 2}));
  maker.sphere({1.5, 0, 0}, 1, maker.material(Dielectric{1.33, 0, 1}));
  test::fill_sphere(maker, {0, 0, 0}, 1, test::add(maker, test::medium(0, 2)));
  const auto scene = maker.build();
  PathCounts counts;
  const PathOptions options{.max_depth = 1000};
  Moments seen;
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const Ray ray{.origin = {-3, 0.2, 0.1}, .direction = {1, 0, 0}};
    seen.add(path_radiance(*scene, ray, PixelSampler(5, i, 3), 0, options, counts).g);
  }
  EXPECT_NEAR(seen.mean(), 1, 4 * seen.standard_error() + 1e-5);
  EXPECT_LE(seen.standard_error(), 0.01);
}

// A mirror shows a diffuse wall. A faint hidden lamp between them does not count as one of the two
// scatterings.
TEST(HiddenLamps, DoNotCountTowardsTheMaximumDepth) {
  const auto seen = [](bool with_lamp) {
    SceneMaker maker = white_sky();
    maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.metal(1, 0));
    maker.quad({-5, -5, 4}, {0, 10, 0}, {10, 0, 0}, maker.diffuse(0.5f));
    if (with_lamp) {
      const MaterialId lamp = maker.lamp(1e-6f);
      std::get<Emissive>(maker.scene.materials[index_of(lamp)].kind).hidden = true;
      maker.quad({-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, lamp);
    }
    const auto scene = maker.build();
    PathCounts counts;
    const PathOptions options{.max_depth = 2};
    Moments light;
    for (std::uint32_t i = 0; i < 1000; ++i) {
      const Ray ray{.origin = {0, 0, 1}, .direction = {0, 0, -1}};
      light.add(path_radiance(*scene, ray, PixelSampler(7, i, 3), 0, options, counts).g);
    }
    return light;
  };
  const Moments without = seen(false);
  const Moments with = seen(true);
  EXPECT_GT(without.mean(), 0.3);
  EXPECT_NEAR(with.mean(), without.mean(), 5 * with.standard_error() + 1e-5);
}

// A ray crosses a ball of glass that does not refract. Its radiance is twice the emission of the
// glass plus 1, the radiance of the sky.
TEST(GlassThatDoesNotRefract, EmitsLikeOtherGlass) {
  SceneMaker maker = white_sky();
  Material glass = Dielectric{1};
  glass.emission.radiance = {TextureId{0}, {2, 3, 4}};
  maker.sphere({0, 0, 0}, 1, maker.material(glass));
  const auto scene = maker.build();
  PathCounts counts;
  const Ray ray{.origin = {0.1, 0.2, 3}, .direction = {0, 0, -1}};
  const Rgb light = path_radiance(*scene, ray, PixelSampler(7, 1, 3), 0, {.max_depth = 8}, counts);
  EXPECT_EQ(light, (Rgb{5, 7, 9}));
}

}  // namespace
}  // namespace bandsaw
