// Tests the pilot of the integrator `path`. The pilot traces a few thousand paths. From them it
// estimates how much variance guiding and photon maps would save, and decides whether the
// integrator uses them.

#include "renderlib/integrate/guiding_gain.h"

#include <gtest/gtest.h>

#include <atomic>

#include "renderlib/integrate/guiding_training.h"
#include "renderlib/render/render_band.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

/// The stop flag of a computation that is not stopped.
const std::atomic<bool> kGoOn = false;
constexpr std::uint32_t kWidth = 24;
constexpr std::uint32_t kHeight = 16;
constexpr std::uint32_t kDepth = 6;

/// Trains path guiding. Returns the variance of paths, and the parts of it that guiding and photon
/// maps would remove.
GuidingGain gain_of(const Scene& scene, int threads = 2) {
  Pool pool(threads);
  const GuidingKey key{kWidth, kHeight, kDepth};
  return *expected_gain(scene, key, train_guiding(scene, key, {pool, kGoOn})->field,
                        {.max_depth = kDepth}, {pool, kGoOn});
}

/// Renders an image with 16 samples in each pixel.
BandPixels pixels_of(const Scene& scene, Integrator integrator) {
  Pool pool(2);
  return *render_band(
      scene, {.width = kWidth, .height = kHeight, .max_depth = kDepth, .integrator = integrator},
      {{0, 16}, {0, kHeight}}, pool, kGoOn, {});
}

/// A wall at a distance of 2 from a lamp of radius `lamp`. The lamp is in glass that does not
/// refract, so that all of its light is a caustic. The camera does not see the lamp.
std::shared_ptr<const Scene> wall_lit_through_glass(double lamp) {
  test::SceneMaker maker;
  maker.quad({-0.2, -0.2, -2}, {0.4, 0, 0}, {0, 0.4, 0}, maker.diffuse(0.5f));
  maker.sphere({0, 0, 0}, lamp, maker.lamp(10));
  maker.sphere({0, 0, 0}, 0.5, maker.glass(1.00001));
  maker.camera({0, 0, -1}, {0, 0, -2}, 15);
  return maker.build();
}

// The lamp is straight in front of the wall, and w is the solid angle of the lamp. So a
// cosine-distributed direction reaches the lamp with probability w / pi. All directions that reach
// the lamp carry the same light. So the second moment is pi / w times the squared mean, and the
// variance is pi / w - 1 times the squared mean.
TEST(GuidingGain, OfPhotonsMeetsTheClosedForm) {
  for (const double lamp : {0.05, 0.1, 0.2, 0.3, 0.4}) {
    const double solid_angle = kPi * lamp * lamp / 4;
    const auto scene = wall_lit_through_glass(lamp);
    const GuidingGain gain = gain_of(*scene);
    const double expected = kPi / solid_angle - 1;
    EXPECT_GT(gain.by_photons, 0.5 * expected) << lamp;
    EXPECT_LT(gain.by_photons, 1.3 * expected) << lamp;
    EXPECT_TRUE(gain.photons_pay());
  }
}

// The lamp is far away behind the wall, and the wall sees it in a mirror. The photons that arrive
// at a cell come from a part of the mirror that is much larger than the image of the lamp in it.
TEST(GuidingGain, OfPhotonsMeetsTheClosedFormOfADistantLampInAMirror) {
  test::SceneMaker maker;
  maker.quad({-0.2, -0.2, -2}, {0.4, 0, 0}, {0, 0.4, 0}, maker.diffuse(0.5f));
  maker.quad({-2, -2, 3}, {8, 0, 0}, {0, 4, 0}, maker.metal(0.9f, 0));
  maker.sphere({20, 0, -50}, 0.5, maker.lamp(1000));
  maker.camera({0, 0, -1}, {0, 0, -2}, 15);
  const Vec3 to_image = Vec3{20, 0, 56} - Vec3{0, 0, -2};
  const double distance = length(to_image);
  const double solid_angle = kPi * 0.25 / (distance * distance);
  const double expected = kPi / (solid_angle * to_image.z / distance) - 1;
  const GuidingGain gain = gain_of(*maker.build());
  EXPECT_GT(gain.by_photons, 0.5 * expected);
  EXPECT_LT(gain.by_photons, 1.3 * expected);
}

TEST(GuidingGain, IsTheSameForAnyNumberOfThreads) {
  const auto scene = test::lamp_in_glass(1.5, 0.05).build();
  const GuidingGain one = gain_of(*scene, 1);
  const GuidingGain three = gain_of(*scene, 3);
  EXPECT_EQ(one.variance, three.variance);
  EXPECT_EQ(one.by_paths, three.by_paths);
  EXPECT_EQ(one.by_photons, three.by_photons);
}

TEST(GuidingGain, IsZeroWhereNothingIsNoisy) {
  test::SceneMaker maker;
  maker.quad({-5, -5, -2}, {10, 0, 0}, {0, 10, 0}, maker.lamp(1));
  maker.camera({0, 0, 0}, {0, 0, -1}, 40);
  const GuidingGain gain = gain_of(*maker.build());
  EXPECT_EQ(gain.variance, 0);
  EXPECT_EQ(gain.by_paths, 0);
  EXPECT_FALSE(gain.paths_pay() || gain.maps_pay() || gain.photons_pay());
  // share_of() returns the share of a part in the sum of this part and the variance. The variance
  // is 0.
  EXPECT_EQ(gain.share_of(0), 0);
  EXPECT_EQ(gain.share_of(1), 1);
}

/// Bars of lamps before a wall that they light. A bar covers a fifth of each pixel's width, so some
/// samples of a pixel see a lamp and others see the wall. The noise of the image comes from this
/// difference. No light is scattered twice.
std::shared_ptr<const Scene> wall_behind_bars() {
  test::SceneMaker maker;
  maker.quad({-5, -5, -3}, {10, 0, 0}, {0, 10, 0}, maker.diffuse(0.5f));
  const MaterialId lamp = maker.lamp(20);
  for (int i = -20; i < 20; ++i) {
    maker.quad({0.1 * i, -3, -2}, {0.02, 0, 0}, {0, 6, 0}, lamp);
  }
  maker.camera({0, 0, 0}, {0, 0, -2}, 40);
  return maker.build();
}

/// A closed room that a lamp under its ceiling lights by way of the ceiling. The camera sees the
/// floor, which no direct light reaches.
std::shared_ptr<const Scene> room_lit_by_its_ceiling() {
  test::SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.7f);
  maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 0, 4}, wall);
  maker.quad({-2, 2, -2}, {4, 0, 0}, {0, 0, 4}, wall);
  maker.quad({-2, -2, -2}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({-2, -2, 2}, {4, 0, 0}, {0, 4, 0}, wall);
  maker.quad({-2, -2, -2}, {0, 4, 0}, {0, 0, 4}, wall);
  maker.quad({2, -2, -2}, {0, 4, 0}, {0, 0, 4}, wall);
  maker.quad({-0.1, 1.8, -0.1}, {0, 0, 0.2}, {0.2, 0, 0}, maker.lamp(50, true));
  maker.camera({0, 0, 0}, {0, -2, -0.1}, 40);
  return maker.build();
}

// Gathering means that indirect light comes from photon maps.
TEST(GuidingGain, DirectLightHasAllNoiseWhereNoLightIsScatteredTwice) {
  const GuidingGain gain = gain_of(*wall_behind_bars());
  EXPECT_GT(gain.variance, 1);
  EXPECT_EQ(gain.direct_variance, gain.variance);
  EXPECT_EQ(gain.direct_rays, gain.rays);
  EXPECT_FALSE(gain.gathering_may_pay());
}

TEST(GuidingGain, DirectLightHasNoNoiseWhereItDoesNotArrive) {
  const GuidingGain gain = gain_of(*room_lit_by_its_ceiling());
  EXPECT_GT(gain.variance, 0.3);
  EXPECT_EQ(gain.direct_variance, 0);
  EXPECT_TRUE(gain.gathering_may_pay());
}

// Photons of indirect light start at 2^17 points or more, and each point takes at least one ray. So
// fewer rays mean that no such photons were traced.
TEST(GuidingGain, NoIndirectPhotonsAreTracedWhereDirectLightHasTheNoise) {
  Pool pool(2);
  const auto rays_of = [&](const Scene& scene) {
    return train_guiding(scene, {kWidth, kHeight, kDepth, /*only_if_it_pays=*/true}, {pool, kGoOn},
                         /*photon_maps=*/true)
        ->rays;
  };
  EXPECT_LT(rays_of(*wall_behind_bars()), 1u << 17);
  EXPECT_GT(rays_of(*room_lit_by_its_ceiling()), 1u << 17);
}

// Light sampling finds the light of a lamp under the ceiling, but not the light of a lamp in glass.
// So `path` guides its paths only in the scene with the lamp in glass.
TEST(GuidingGain, DecidesWhetherTheIntegratorPathIsGuided) {
  const auto easy = test::cornell_box().build();
  EXPECT_EQ(pixels_of(*easy, Integrator::kPath).sums,
            pixels_of(*easy, Integrator::kPathPlain).sums);
  EXPECT_NE(pixels_of(*easy, Integrator::kPath).sums,
            pixels_of(*easy, Integrator::kPathGuided).sums);
  const auto hard = test::lamp_in_glass(1.5, 0.05).build();
  EXPECT_NE(pixels_of(*hard, Integrator::kPath).sums,
            pixels_of(*hard, Integrator::kPathPlain).sums);
}

TEST(GuidingGain, AStoppedPilotReturnsNothing) {
  Pool pool(2);
  const std::atomic<bool> stop = true;
  const auto scene = test::cornell_box().build();
  EXPECT_EQ(train_guiding(*scene, {kWidth, kHeight, kDepth, /*only_if_it_pays=*/true}, {pool, stop},
                          /*photon_maps=*/true),
            nullptr);
}

TEST(GuidingGain, ThePilotReportsItsProgress) {
  Pool pool(2);
  std::atomic<int> steps = 0;
  const auto scene = test::cornell_box().build();
  const auto trained = train_guiding(*scene, {kWidth, kHeight, kDepth, /*only_if_it_pays=*/true},
                                     {pool, kGoOn, [&] { ++steps; }}, /*photon_maps=*/true);
  EXPECT_EQ(trained->field.cells(), 0u);
  EXPECT_GT(trained->rays, 0u);
  EXPECT_GE(steps, 64);
}

}  // namespace
}  // namespace bandsaw
