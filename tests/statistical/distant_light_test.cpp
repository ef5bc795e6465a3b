// Compares the light of environments and delta lights with closed forms and quadrature, within 4
// standard errors. The standard error is at most 1e-3 of the value. An id such as L8 in a test's
// name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/math/elementary.h"
#include "tests/statistical/estimate.h"
#include "tests/support/environments.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::float_image;
using test::Moments;
using test::SceneMaker;

/// Adds a patch of this material at the origin, tilted by `tilt` degrees about z towards -x.
void add_patch(SceneMaker& maker, double tilt, MaterialId material) {
  const SinCos turn = sincos_degrees(tilt);
  const Vec3 along{turn.cos * 0.02, turn.sin * 0.02, 0};
  maker.quad(along * -0.5 + Vec3{0, 0, -0.01}, {0, 0, 0.02}, along, material);
}

/// Returns a ray that hits the patch of add_patch() along its normal.
Ray onto_patch(double tilt) {
  const SinCos turn = sincos_degrees(tilt);
  const Vec3 normal{-turn.sin, turn.cos, 0};
  return {.origin = normal * 1e-3, .direction = -normal};
}

/// Expects that the radiance along the ray is `expected`, within 4 standard errors. The standard
/// error may be at most 1e-3 of `expected`.
void expect_radiance(const SceneMaker& maker, const Ray& ray, double expected,
                     const PathOptions& options, std::uint64_t samples = 1024) {
  const Moments radiance = test::radiance_along(*maker.build(), ray, options, samples);
  EXPECT_NEAR(radiance.mean(), expected, 4 * radiance.standard_error() + 2e-6 * expected);
  EXPECT_LE(radiance.standard_error(), 1e-3 * expected + 1e-12);
}

/// Sets an environment of one image.
void set_environment(SceneMaker& maker, ImageTexture image) {
  Environment environment;
  environment.images = {maker.texture(std::move(image))};
  maker.scene.background.environment = environment;
}

/// Returns an image whose upper half is white and whose lower half is black.
ImageTexture half_white() {
  return float_image(1, 2048, [](auto, auto y) { return y < 1024 ? 1.0f : 0.0f; });
}

TEST(EnvironmentLight, AHalfWhiteImageGivesTheClosedFormOnATiltedPlane) {
  for (const double tilt : {0.0, 30.0, 90.0, 150.0}) {
    SceneMaker maker;
    set_environment(maker, half_white());
    add_patch(maker, tilt, maker.diffuse(1));
    const double expected = (1 + sincos_degrees(tilt).cos) / 2;
    // Local shading (direct light only) must use the whole environment too.
    for (const bool local : {false, true}) {
      expect_radiance(maker, onto_patch(tilt), expected, {.max_depth = 1, .local = local}, 4096);
    }
  }
}

TEST(EnvironmentLight, L8OneTexelGivesTheLightOfTheQuadrature) {
  for (const std::uint32_t row : {0u, 3u, 70u}) {
    constexpr std::uint32_t kWidth = 400;
    constexpr std::uint32_t kHeight = 200;
    SceneMaker maker;
    set_environment(maker, float_image(kWidth, kHeight, [&](auto x, auto y) {
                      return x == 20 && y == row ? 1e5f : 0.0f;
                    }));
    add_patch(maker, 0, maker.diffuse(1));
    // The irradiance is the integral of the interpolated radiance times the cosine over the solid
    // angle. It is computed by quadrature over the rows. Across the columns, interpolation does not
    // change the integral, so the texel counts as one column of full brightness.
    double expected = 0;
    constexpr int kFine = 2000;
    for (int i = 0; i < kFine; ++i) {
      const double y = row - 1.0 + 3.0 * (i + 0.5) / kFine;
      if (y > 0) {
        const double clamped = std::max(y, 0.5);
        const double tent = std::max(0.0, 1 - std::abs(clamped - row - 0.5));
        const double theta = y / kHeight * kPi;
        expected += tent * std::sin(theta) * std::cos(theta) * 3 * kPi / (kFine * kHeight);
      }
    }
    expected *= 1e5 * 2 * kPi / kWidth;
    expect_radiance(maker, onto_patch(0), expected / kPi, {.max_depth = 1});
  }
  test::report_hard_case("L8", "reflected radiance within 4 SE of the integral over the texel");
}

/// A sun on a sky with bands, above a dark ground.
ImageTexture sunny() {
  return float_image(32, 16, [](auto x, auto y) {
    return x == 5 && y == 4 ? 300.0f
           : y < 8          ? 0.2f + 0.1f * static_cast<float>((x + y) % 5)
                            : 0.05f;
  });
}

/// Returns the radiance of a white diffuse patch with this normal under the background alone. It is
/// the integral of the background's radiance times the cosine, divided by pi; the integral is
/// computed by quadrature.
double reflected(const SceneMaker& maker, const Vec3& normal) {
  constexpr int kBands = 1600;
  double sum = 0;
  for (int i = 0; i < kBands; ++i) {
    const double y = (i + 0.5) / kBands * 2 - 1;
    const double r = std::sqrt(1 - y * y);
    for (int j = 0; j < 2 * kBands; ++j) {
      const SinCos turn = sincos_turns((j + 0.5) / (2 * kBands));
      const Vec3 d{r * turn.cos, y, r * turn.sin};
      const double cosine = dot(d, normal);
      if (cosine > 0) {
        sum += cosine * radiance(maker.scene.background, maker.scene.textures, d).g;
      }
    }
  }
  return sum * 2 / kBands / kBands;
}

TEST(EnvironmentLight, AllTechniquesAgreeWithQuadrature) {
  SceneMaker maker;
  set_environment(maker, sunny());
  add_patch(maker, 20, maker.diffuse(1));
  const double expected = reflected(maker, -onto_patch(20).direction);
  const Ray ray = onto_patch(20);
  expect_radiance(maker, ray, expected, {.max_depth = 1});
  expect_radiance(maker, ray, expected, {.max_depth = 1, .local = true});
  const auto scene = maker.build();
  for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
    const Moments alone =
        test::radiance_along(*scene, ray, {.max_depth = 1, .technique = technique}, 8192);
    EXPECT_LE(std::abs(alone.z(expected)), 4) << static_cast<int>(technique);
  }
}

TEST(EnvironmentLight, AllTechniquesAgreeInASceneOfManyMaterials) {
  SceneMaker maker;
  set_environment(maker, sunny());
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.diffuse(0.6f));
  maker.sphere({-1, 0.7, 0}, 0.7, maker.metal(0.9f, 0.2));
  maker.sphere({0.8, 0.7, 0.2}, 0.7, maker.glass(1.5));
  maker.sphere({0, 2.5, 0}, 0.3, maker.lamp(4));
  const auto scene = maker.build();
  for (const Vec3& target : {Vec3{0, 0, 0.4}, Vec3{-0.9, 0.8, 0.5}, Vec3{0.9, 0.3, 0.5}}) {
    const Vec3 eye{0.3, 1.8, 5};
    const Ray ray{.origin = eye, .direction = normalize(target - eye)};
    const Moments both = test::radiance_along(*scene, ray, {.max_depth = 6}, 4096);
    for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
      const Moments alone =
          test::radiance_along(*scene, ray, {.max_depth = 6, .technique = technique}, 8192);
      const double error = std::hypot(both.standard_error(), alone.standard_error());
      EXPECT_LE(std::abs(both.mean() - alone.mean()), 4 * error) << static_cast<int>(technique);
    }
  }
}

TEST(EnvironmentLight, C10AMirrorShowsTheEnvironmentInItsDirection) {
  SceneMaker maker;
  set_environment(maker, sunny());
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.metal(1, 0));
  const Vec3 down = normalize(Vec3{0.4, -0.3, 0.8});
  const Rgb expected =
      radiance(maker.scene.background, maker.scene.textures, {down.x, -down.y, down.z});
  const Ray ray{.origin = {0, 1, 0}, .direction = down};
  expect_radiance(maker, ray, expected.g, {.max_depth = 4}, 16);
  test::report_hard_case("C10", "a mirror shows the environment in the mirrored direction");
}

TEST(EnvironmentLight, C10LosslessObjectsAreInvisibleInAWhiteEnvironment) {
  SceneMaker maker;
  set_environment(maker, float_image(8, 4, [](auto, auto) { return 1.0f; }));
  maker.sphere({-2, 0, 0}, 0.9, maker.metal(1, 0));
  maker.sphere({0, 0, 0}, 0.9, maker.glass(1.5));
  maker.sphere({2, 0, 0}, 0.9, maker.diffuse(1));
  EXPECT_TRUE(maker.build()->lights().empty())
      << "a constant environment must be no light, so that no shadow ray is spent on it";
  for (const double x : {-2.0, 0.0, 2.0}) {
    const Ray ray{.origin = {x + 0.4, 0.3, 5}, .direction = {0, 0, -1}};
    expect_radiance(maker, ray, 1, {.max_depth = 1000, .russian_roulette = false}, 64);
  }
  test::report_hard_case("C10", "objects without absorption are invisible in a white environment");
}

TEST(DeltaLight, EachKindGivesTheClosedForm) {
  const double cosine = std::cos(0.6);
  const Vec3 to_light{std::sin(0.6), cosine, 0};
  const auto lit_by = [](const DeltaLight& light) {
    SceneMaker maker;
    maker.scene.lights = {light};
    add_patch(maker, 0, maker.diffuse(1));
    return maker;
  };
  const PathOptions options{.max_depth = 1};
  const Ray ray = onto_patch(0);
  expect_radiance(lit_by(DirectionalLight{-to_light, {3, 3, 3}}), ray, 3 * cosine / kPi, options,
                  4);
  expect_radiance(lit_by(PointLight{to_light * 7, {50, 50, 50}}), ray, 50 * cosine / 49 / kPi,
                  options, 4);
  SpotLight spot{.position = to_light * 7, .direction = -to_light, .intensity = {50, 50, 50}};
  expect_radiance(lit_by(spot), ray, 50 * cosine / 49 / kPi, options, 4);
  // The patch is 40 degrees off the spot's axis. The light falls off between 30 and 50 degrees.
  spot.direction = normalize(rotation(cross(to_light, {1, 2, 0.5}), 40).direction(-to_light));
  const double off = dot(-to_light, spot.direction);
  spot.cos_inner = sincos_degrees(30).cos;
  spot.cos_outer = sincos_degrees(50).cos;
  const double ramp = (off - spot.cos_outer) / (spot.cos_inner - spot.cos_outer);
  expect_radiance(lit_by(spot), ray, 50 * ramp * ramp * cosine / 49 / kPi, options, 4);
  spot.cos_outer = spot.cos_inner = off + 1e-6;
  expect_radiance(lit_by(spot), ray, 0, options, 4);
  spot.cos_outer = spot.cos_inner = off - 1e-6;
  expect_radiance(lit_by(spot), ray, 50 * cosine / 49 / kPi, options, 4);
}

TEST(DeltaLight, EachFalloffOfASpotHasItsClosedForm) {
  SceneMaker maker;
  add_patch(maker, 0, maker.diffuse(1));
  // The patch is 40 degrees off the spot's axis. The light falls off between 30 and 50 degrees.
  SpotLight spot{.position = {0, 7, 0},
                 .direction = rotation({1, 0, 0}, 40).direction({0, -1, 0}),
                 .intensity = gray(50),
                 .cos_inner = sincos_degrees(30).cos,
                 .cos_outer = sincos_degrees(50).cos};
  const double ramp = (sincos_degrees(40).cos - spot.cos_outer) / (spot.cos_inner - spot.cos_outer);
  using Falloff = SpotLight::Falloff;
  for (const auto& [falloff, share] : {std::pair(Falloff::kSquare, ramp * ramp),
                                       std::pair(Falloff::kSmooth, ramp * ramp * (3 - 2 * ramp)),
                                       std::pair(Falloff::kLinearAngle, 0.5)}) {
    spot.falloff = falloff;
    maker.scene.lights = {spot};
    expect_radiance(maker, onto_patch(0), 50 * share / 49 / kPi, {.max_depth = 1}, 4);
  }
}

/// Adds a white floor in the plane y = 0.
void add_floor(SceneMaker& maker) {
  maker.quad({-20, 0, -20}, {0, 0, 40}, {40, 0, 0}, maker.diffuse(1));
}

/// Returns a ray that hits the floor from above at (x, z).
Ray onto_floor(double x, double z) { return {.origin = {x, 0.1, z}, .direction = {0, -1, 0}}; }

/// Four texels of different values, without interpolation. In uv: (0, 0) is 1, (1, 0) is 2, (0, 1)
/// is 3, (1, 1) is 4.
ImageTexture four_values() {
  ImageTexture image =
      float_image(2, 2, [](auto x, auto y) { return static_cast<float>(y == 1 ? 1 + x : 3 + x); });
  image.filter = ImageTexture::Filter::kNearest;
  return image;
}

/// On a plane perpendicular to the axis a texel gives the same irradiance everywhere, and there is
/// no light beyond the image.
TEST(DeltaLight, AProjectorShowsItsImageOnAPlane) {
  SceneMaker maker;
  add_floor(maker);
  // At a height of 3 the image covers [-1.5, 1.5] x [-4.5, 4.5] around (1, 2).
  const ProjectorLight light{
      .position = {1, 3, 2},
      .direction = {0, -1, 0},
      .intensity = gray(9),
      .image = {maker.texture(four_values()), {1, 0, 0}, {0, 0, -1}, 0.5, 1.5}};
  maker.scene.lights = {light};
  const auto expect = [&](double x, double z, double value) {
    expect_radiance(maker, onto_floor(1 + x, 2 + z), value / kPi, {.max_depth = 1}, 4);
  };
  expect(-0.1, 0.1, 1);
  expect(-1.49, 4.49, 1);
  expect(0.1, 0.1, 2);
  expect(1.49, 4.49, 2);
  expect(-1.49, -4.49, 3);
  expect(1.49, -4.49, 4);
  expect(1.51, 0, 0);
  expect(0, -4.51, 0);
  // This placement mirrors the projector in x and keeps its position. So the image is mirrored.
  maker.scene.lights = {placed(light, translation({2, 0, 0}) * scaling({-1, 1, 1}))};
  expect(0.1, 0.1, 1);
  expect(-1.49, -4.49, 4);
}

TEST(DeltaLight, AProjectorShinesForwardsOnly) {
  SceneMaker maker;
  add_floor(maker);
  maker.scene.lights = {
      ProjectorLight{.position = {0, 3, 0},
                     .direction = {0, 1, 0},
                     .image = {maker.texture(four_values()), {1, 0, 0}, {0, 0, 1}, 9, 9}}};
  expect_radiance(maker, onto_floor(0.1, 0.1), 0, {.max_depth = 1}, 4);
}

TEST(DeltaLight, ASpotsImageCoversTheSquareAroundItsCone) {
  SceneMaker maker;
  add_floor(maker);
  SpotLight spot{.position = {0, 2, 0},
                 .direction = {0, -1, 0},
                 .intensity = gray(8),
                 .cos_inner = sincos_degrees(45).cos,
                 .cos_outer = sincos_degrees(45).cos};
  spot.image = ProjectedImage{maker.texture(four_values()), {1, 0, 0}, {0, 0, -1}, 1, 1};
  maker.scene.lights = {spot};
  // The intensity is 8 times the image. The distance is sqrt(4 + x^2 + z^2) = sqrt(6), and the
  // cosine of the angle is 2 / distance.
  for (const auto& [x, z, value] :
       {std::array<double, 3>{-1, 1, 1}, std::array<double, 3>{1, 1, 2},
        std::array<double, 3>{-1, -1, 3}, std::array<double, 3>{1, -1, 4}}) {
    const double distance = std::sqrt(6);
    const double expected = 8 * value * 2 / (distance * distance * distance) / kPi;
    expect_radiance(maker, onto_floor(x, z), expected, {.max_depth = 1}, 4);
  }
  expect_radiance(maker, onto_floor(1.5, 1.5), 0, {.max_depth = 1}, 4);
}

/// The images of all projectors add up. Few lights are selected from a list, many from the light
/// tree; neither selection may lose a projector.
TEST(DeltaLight, ManyProjectorsAddUp) {
  for (const int count : {12, 60}) {
    SceneMaker maker;
    add_floor(maker);
    const TextureId image = maker.texture(four_values());
    double expected = 0;
    for (int i = 0; i < count; ++i) {
      const double height = 2 + 0.1 * i;
      const double x = 0.2 * i - 3;
      const double half = 0.4 + 0.05 * i;
      maker.scene.lights.push_back(
          ProjectorLight{.position = {x, height, 0},
                         .direction = {0, -1, 0},
                         .image = {image, {1, 0, 0}, {0, 0, -1}, half, 1}});
      // The point (0, 0.3) is in the lower half of the image.
      if (std::abs(x) < half * height) {
        expected += (x > 0 ? 1 : 2) / (height * height) / kPi;
      }
    }
    ASSERT_GT(expected, 0);
    expect_radiance(maker, onto_floor(0, 0.3), expected, {.max_depth = 1}, 1 << 16);
  }
}

TEST(DeltaLight, IsZeroBelowTheHorizonOrBehindAnOccluder) {
  const std::vector<DeltaLight> above = {DirectionalLight{{0, -1, 0}, {1, 1, 1}},
                                         PointLight{{0, 5, 0}, {1, 1, 1}},
                                         SpotLight{.position = {0, 5, 0}, .direction = {0, -1, 0}}};
  for (const DeltaLight& light : above) {
    SceneMaker maker;
    maker.scene.lights = {light};
    add_patch(maker, 180, maker.diffuse(1));
    expect_radiance(maker, onto_patch(180), 0, {.max_depth = 1}, 4);
    SceneMaker blocked;
    blocked.scene.lights = {light};
    add_patch(blocked, 0, blocked.diffuse(1));
    blocked.quad({-1, 1, -1}, {0, 0, 2}, {2, 0, 0}, blocked.diffuse(0));
    expect_radiance(blocked, onto_patch(0), 0, {.max_depth = 1}, 4);
  }
}

TEST(DeltaLight, DeltaLightsAnAreaLightAndAnEnvironmentAddUp) {
  for (const int points : {1, 40}) {  // few lights, and a light tree
    SceneMaker maker;
    set_environment(maker, half_white());
    add_patch(maker, 0, maker.diffuse(1));
    maker.scene.lights = {DirectionalLight{{0, -1, 0}, {2, 2, 2}}};
    double expected = 1 + 2 / kPi;
    for (int i = 0; i < points; ++i) {
      const Vec3 at{1 + 0.1 * i, 2, 0.05 * i};
      maker.scene.lights.push_back(PointLight{at, {9, 9, 9}});
      const double distance = length(at);
      expected += 9 * at.y / (distance * distance * distance) / kPi;
    }
    // This lamp is near the horizon. It hides 1e-4 of the sky, which is below the tolerance.
    maker.sphere({-30, 3, 0}, 0.2, maker.lamp(2000));
    const Vec3 lamp{-30, 3, 0};
    expected += 2000 * 0.04 * lamp.y / std::pow(length(lamp), 3);
    expect_radiance(maker, onto_patch(0), expected, {.max_depth = 1}, 8192);
  }
}

}  // namespace
}  // namespace bandsaw
