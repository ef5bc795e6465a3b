// Compares disk lights, instanced lights, moving lights and motion blur with closed forms, within 4
// standard errors over 32 seeds. An id such as X9 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "renderlib/render/render_band.h"
#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Returns an instance of the group of shapes with index `group`. The shapes keep their own
/// materials.
Instance of_group(std::uint32_t group, const Transform& to_world) {
  Instance instance;
  instance.group = GroupId{group};
  instance.material = kOwnMaterial;
  instance.to_world = to_world;
  return instance;
}

/// Adds a small white patch at the origin with the normal +y, and expects that its irradiance is
/// `expected`, averaged over the time in which the shutter is open.
void expect_irradiance(SceneMaker maker, double expected, std::uint64_t samples = 1024,
                       Technique technique = Technique::kBoth) {
  maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  const Shutter& shutter = shutter_of(scene->camera());
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 11, 7);
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const double share = sampler.group(sample, kGroupTime)[0];
      const double time = shutter.open + share * (shutter.close - shutter.open);
      const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}, .time = time};
      sum += path_radiance(*scene, down, sampler, sample, {.max_depth = 1, .technique = technique},
                           counts)
                 .g;
    }
    means.add(sum / static_cast<double>(samples));
  }
  const double value = expected / kPi;
  EXPECT_NEAR(means.mean(), value, 4 * means.standard_error() + 1e-6 * value)
      << "is " << means.mean() * kPi << ", expected " << expected;
  EXPECT_LE(means.standard_error(), 1e-3 * value);
}

TEST(DiskLight, HasItsClosedForm) {
  for (const double d : {0.3, 1.0, 4.0}) {
    SceneMaker maker;
    maker.scene.geometry.disks.push_back({{0, d, 0}, {0, -1, 0}, 1.5, maker.lamp(1, true)});
    expect_irradiance(maker, kPi * 1.5 * 1.5 / (1.5 * 1.5 + d * d), 8192);
  }
  SceneMaker behind;
  behind.scene.geometry.disks.push_back({{0, 1, 0}, {0, 1, 0}, 1.5, behind.lamp(1, true)});
  expect_irradiance(behind, 0);
}

// X9: instanced lights emit according to their size in the world.
TEST(PlacedLight, X9_EmitsAccordingToItsSizeInTheWorld) {
  SceneMaker disk;
  disk.scene.geometry.groups.resize(1);
  disk.scene.geometry.groups[0].disks.push_back({{0, 0, 0}, {0, 0, 1}, 0.5, disk.lamp(1)});
  disk.scene.geometry.instances.push_back(
      of_group(0, translation({0, 2, 0}) * rotation({1, 0, 0}, 90) * scaling({-3, 3, 7})));
  expect_irradiance(disk, kPi * 2.25 / (2.25 + 4), 4096);

  SceneMaker ball;
  ball.scene.geometry.groups.resize(1);
  ball.scene.geometry.groups[0].spheres.push_back({{1, 0, 0}, 0.25, ball.lamp(1)});
  ball.scene.geometry.instances.push_back(
      of_group(0, rotation({0, 0, 1}, 60) * scaling({4, 4, -4})));
  expect_irradiance(ball, kPi / 16 * std::cos(kPi / 6));

  SceneMaker quad;
  quad.scene.geometry.groups.resize(1);
  quad.scene.geometry.groups[0].quads.push_back(
      {{-0.5, 0, -0.5}, {1, 0, 0}, {0, 0, 1}, quad.lamp(1)});
  quad.scene.geometry.instances.push_back(of_group(0, translation({0, 1, 0}) * scaling({2, 9, 2})));
  // A square of side 2 at distance 1, parallel to the patch: 2 sqrt(2) atan(1 / sqrt(2)).
  expect_irradiance(quad, 1.740839502734);
  test::report_hard_case("X9", "irradiance from scaled lights within 4 SE of the closed form");
}

// Light sampling and BSDF sampling agree for an ellipsoid over a point. A flat ellipsoid gives
// nearly the irradiance of a disk.
TEST(PlacedLight, AllTechniquesAgreeForAnEllipsoid) {
  SceneMaker maker;
  maker.scene.geometry.groups.resize(1);
  maker.scene.geometry.groups[0].spheres.push_back({{0, 0, 0}, 1, maker.lamp(1)});
  maker.scene.geometry.instances.push_back(
      of_group(0, translation({0, 2, 0}) * scaling({1.5, 1e-4, 1.5})));
  expect_irradiance(maker, kPi * 2.25 / (2.25 + 4), 8192);

  maker.scene.geometry.instances[0].to_world =
      translation({0.4, 1.2, 0}) * rotation({1, 1, 1}, 50) * scaling({0.4, 0.9, 0.6});
  SceneMaker patch = maker;
  patch.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, patch.diffuse(1));
  const auto scene = patch.build();
  const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}};
  Moments found[3];
  const Technique techniques[] = {Technique::kBoth, Technique::kLightsOnly,
                                  Technique::kScatteringOnly};
  for (std::size_t i = 0; i < 3; ++i) {
    found[i] =
        test::radiance_along(*scene, down, {.max_depth = 1, .technique = techniques[i]}, 8192);
  }
  for (std::size_t i = 1; i < 3; ++i) {
    const double error = std::hypot(found[0].standard_error(), found[i].standard_error());
    EXPECT_NEAR(found[0].mean(), found[i].mean(), 4 * error) << i;
    EXPECT_LE(error, 3e-3 * found[0].mean());
  }
}

/// Returns a scene whose only instance, the shapes of `lamp`, moves from `from` to `to` while the
/// shutter is open. The scene's MaterialId{0} emits the radiance 1.
SceneMaker moving_lamp(const Shapes& lamp, const Key& from, const Key& to) {
  SceneMaker maker;
  maker.lamp(1);
  Geometry& g = maker.scene.geometry;
  g.groups = {lamp};
  g.frames = {{kNoFrame, {}, {from, to}}};
  g.instances.push_back(of_group(0, {}));
  g.instances[0].frame = FrameId{0};
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = {from.time, to.time};
  return maker;
}

// The irradiance under a ball of radius r at the height h is pi r^2 / h^2. If the height changes
// from a to b at constant speed, the mean of the irradiance over the time is pi r^2 / (a b).
TEST(MovingLight, EmitsFromItsPositionAtEachTime) {
  Shapes ball;
  ball.spheres.push_back({{0, 0, 0}, 0.5, MaterialId{0}});
  for (const Technique technique : {Technique::kBoth, Technique::kLightsOnly}) {
    expect_irradiance(
        moving_lamp(ball, Key(-1, translation({0, 1.5, 0})), Key(3, translation({0, 4, 0}))),
        kPi * 0.25 / (1.5 * 4), 4096, technique);
  }
  // The disk rotates about its middle. It emits from both sides, so one side is always visible.
  Shapes disk;
  disk.disks.push_back({{0, 0, 0}, {0, 1, 0}, 0.05, MaterialId{0}});
  // The irradiance of a small disk is A |cos| / d^2; the mean of |cos| over half a turn is 2 / pi.
  const double closed_form = kPi * 0.0025 / 100 * 2 / kPi;
  SceneMaker turning = moving_lamp(disk, Key(0, translation({0, 10, 0})),
                                   Key(1, translation({0, 10, 0}) * rotation({1, 0, 0}, 90)));
  turning.scene.geometry.frames[0].keys.emplace_back(
      2, translation({0, 10, 0}) * rotation({1, 0, 0}, 180));
  std::get<PerspectiveCamera>(turning.scene.camera).shutter = {0, 2};
  SceneMaker maker = turning;
  maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 3, 4);
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < 4096; ++sample) {
      const double time = 2 * sampler.group(sample, kGroupTime)[0];
      const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}, .time = time};
      sum += path_radiance(*scene, down, sampler, sample, {.max_depth = 1}, counts).g;
    }
    means.add(sum / 4096);
  }
  // The closed form is that of an infinitely small disk. The radius of the disk here is 1/200 of
  // its distance, so its irradiance may differ by about (1/200)^2 = 2.5e-5 of the value. A
  // difference of 2e-4 is accepted.
  EXPECT_NEAR(means.mean() * kPi, closed_form,
              4 * kPi * means.standard_error() + 2e-4 * closed_form);
}

// C9: a bright half-plane whose edge moves by ten pixels.
TEST(MotionBlur, C9_AMovingEdgeIsALinearRamp) {
  constexpr int kWidth = 24;
  SceneMaker maker;
  Shapes half;
  half.quads.push_back({{-100, -100, -5}, {105, 0, 0}, {0, 200, 0}, maker.lamp(1)});  // up to x = 5
  Geometry& g = maker.scene.geometry;
  g.groups = {half};
  g.frames = {{kNoFrame, {}, {Key(0, {}), Key(1, translation({10, 0, 0}))}}};
  g.instances.push_back(of_group(0, {}));
  g.instances[0].frame = FrameId{0};
  maker.scene.camera = OrthographicCamera{.position = {kWidth / 2.0, 0.5, 0},
                                          .look_at = {kWidth / 2.0, 0.5, -1},
                                          .height = 1,
                                          .shutter = {0, 1}};
  const auto scene = maker.build();
  Pool pool(1);
  const std::atomic<bool> stop = false;
  std::vector<Moments> pixels(kWidth);
  constexpr std::uint64_t kSamples = 256;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const auto band = render_band(*scene, {.width = kWidth, .height = 1, .seed = seed},
                                  {{0, kSamples}, {0, 1}}, pool, stop, {});
    ASSERT_TRUE(band.ok());
    for (std::size_t x = 0; x < kWidth; ++x) {
      pixels[x].add(band->sums[3 * x + 1] / kSamples);
    }
  }
  // A point of a pixel is bright while the edge, at x = 5 + 10 t, is to the right of the point,
  // that is, for a share of the time. The expected value of the pixel is the mean of this share
  // over all points of the pixel.
  const auto integral = [](double x) {  // integral of clamp(x, 0, 10) / 10
    return x < 0 ? 0 : x < 10 ? x * x / 20 : x - 5;
  };
  for (int x = 0; x < kWidth; ++x) {
    const double expected = 1 - (integral(x + 1 - 5) - integral(x - 5));
    EXPECT_NEAR(pixels[static_cast<std::size_t>(x)].mean(), expected,
                4 * pixels[static_cast<std::size_t>(x)].standard_error() + 1e-9)
        << x;
  }
  test::report_hard_case("C9", "moving instance: pixels within 4 SE of the linear ramp");
}

}  // namespace
}  // namespace bandsaw
