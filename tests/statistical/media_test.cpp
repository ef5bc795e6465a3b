// Compares the light in media (smoke, fog) with closed forms and quadratures. A value may differ by
// at most 4 standard errors. A value without noise may differ only by the rounding to float. An id
// such as V6 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "tests/statistical/estimate.h"
#include "tests/support/environments.h"
#include "tests/support/hard_case.h"
#include "tests/support/media.h"

namespace bandsaw {
namespace {

using test::medium;
using test::Moments;
using test::SceneMaker;

/// Expects that the mean is `expected` within 4 standard errors. `relative_error`: the largest
/// standard error that is accepted, relative to `expected`.
void expect_value(const Moments& radiance, double expected, double relative_error) {
  EXPECT_LE(std::abs(radiance.mean() - expected), 4 * radiance.standard_error() + 2e-6 * expected)
      << "is " << radiance.mean() << " +- " << radiance.standard_error() << ", expected "
      << expected;
  EXPECT_LE(radiance.standard_error(), relative_error * expected);
}

/// Returns the radiance along the ray by a single sample, for scenes without noise.
double one_sample(const Scene& scene, const Ray& ray, const PathOptions& options = {}) {
  PathCounts counts;
  return path_radiance(scene, ray, PixelSampler(3, 1, 2), 0, options, counts).g;
}

SceneMaker white_sky() {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  return maker;
}

TEST(Media, V6AbsorptionIsExponential) {
  // Rays through one and two spheres, at several distances from their middle.
  for (const double b : {0.0, 0.3, 0.9, 0.999999}) {
    SceneMaker maker = white_sky();
    const MediumId smoke = test::add(maker, medium(0.7f, 0));
    test::fill_sphere(maker, {0, 0, 0}, 2, smoke);
    const Ray ray{.origin = {-9, 2 * b, 0}, .direction = {1, 0, 0}};
    const double chord = 4 * std::sqrt(1 - b * b);
    EXPECT_NEAR(one_sample(*maker.build(), ray), std::exp(-0.7 * chord), 1e-6);
    test::fill_sphere(maker, {5, 0, 0}, 2, smoke);
    EXPECT_NEAR(one_sample(*maker.build(), ray), std::exp(-0.7 * 2 * chord), 1e-6);
  }
  // Each channel by itself, through a slab, at an angle.
  SceneMaker maker = white_sky();
  test::fill_box(maker, {-99, 0, -99}, {99, 2, 99}, test::add(maker, {.absorption = {0, 0.5f, 2}}));
  PathCounts counts;
  const Ray ray{.origin = {0, 5, 0}, .direction = normalize({1, -1, 0})};
  const Rgb seen = path_radiance(*maker.build(), ray, PixelSampler(3, 1, 2), 0, {}, counts);
  EXPECT_EQ(seen.r, 1);
  EXPECT_NEAR(seen.g, std::exp(-std::sqrt(2.0)), 1e-6);
  EXPECT_NEAR(seen.b, std::exp(-4 * std::sqrt(2.0)), 1e-6);
  test::report_hard_case("V6", "T within 4 SE of the closed form");
}

/// First the camera is in the middle of a ball of smoke, and the light is inside of the ball, on
/// its boundary or outside. Then camera and light are in endless fog. The expected transmittance is
/// exp(-0.5 d), where d is the length of the camera ray in the medium.
TEST(Media, V7AroundTheCameraAttenuateALight) {
  const Ray ray{.origin = {0, 0, 0}, .direction = {0, 0, -1}};
  for (const double distance : {0.5, 2.0, 3.0}) {
    const auto with_lamp = [&] {
      SceneMaker maker;
      maker.quad({-1, -1, -distance}, {2, 0, 0}, {0, 2, 0}, maker.lamp(5));
      return maker;
    };
    SceneMaker ball = with_lamp();
    test::fill_sphere(ball, {0, 0, 0}, 2, test::add(ball, medium(0.5f, 0)));
    const double inside = std::min(distance, 2.0);
    EXPECT_NEAR(one_sample(*ball.build(), ray), 5 * std::exp(-0.5 * inside), 1e-5);
    SceneMaker everywhere = with_lamp();
    test::fog(everywhere, medium(0.5f, 0));
    EXPECT_NEAR(one_sample(*everywhere.build(), ray), 5 * std::exp(-0.5 * distance), 1e-5);
  }
  test::report_hard_case("V7", "radiance of the light within 4 SE of the closed form");
}

/// The camera ray hits a light behind media. Every path gets the light of this hit, attenuated by
/// the media, even if the path is scattered in front of the light (about half of the paths are). So
/// the pixel has no noise.
TEST(Media, InFrontOfALightAttenuateEverySampleEqually) {
  SceneMaker maker;
  maker.sphere({10, 0, 0}, 1e-3, maker.lamp(5));
  test::fog(maker, medium(0.01f, 0.05f));
  test::fill_sphere(maker, {5, 0, 0}, 1, test::add(maker, medium(0, 0.25f)));
  const Ray ray{.origin = {0, 0, 0}, .direction = {1, 0, 0}};
  const Moments seen =
      test::radiance_along(*maker.build(), ray, {.technique = Technique::kScatteringOnly}, 256);
  expect_value(seen, 5 * std::exp(-0.06 * (8 - 1e-3) - 0.25 * 2), 1e-6);
}

TEST(Media, EmitInProportionToTheirEffectiveLength) {
  SceneMaker maker = white_sky();
  const MediumId flame = test::add(maker, {.absorption = {0, 1, 0}, .emission = {0, 3, 0}});
  test::fill_sphere(maker, {0, 0, 0}, 1, flame);
  const Ray ray{.origin = {-9, 0, 0}, .direction = {1, 0, 0}};
  const double passing = std::exp(-2.0);
  EXPECT_NEAR(one_sample(*maker.build(), ray), passing + 3 * (1 - passing), 1e-5);
}

/// Returns the integral over [0, inf) of f, by the substitution s = x / (1 - x) and Simpson's rule.
double integral(const std::function<double(double)>& f) {
  constexpr int kSteps = 200000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto at = [&](double x) { return x >= 1 ? 0 : f(x / (1 - x)) / ((1 - x) * (1 - x)); };
    const double h = 1.0 / kSteps;
    sum += h / 6 * (at(i * h) + 4 * at((i + 0.5) * h) + at((i + 1) * h));
  }
  return sum;
}

/// Returns the singly scattered radiance along x for a light of this intensity at (ahead, aside).
double scattered_once(const Medium& fog, double ahead, double aside, double intensity) {
  const double sigma = double{fog.absorption.g} + fog.scattering.g;
  const double g = fog.g;
  return integral([&](double s) {
    const double along = ahead - s;
    const double r2 = along * along + aside * aside;
    const double r = std::sqrt(r2);
    const double cosine = along / r;
    const double p = (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * cosine, 1.5));
    return fog.scattering.g * p * std::exp(-sigma * (s + r)) * intensity / r2;
  });
}

/// Compares the radiance along a ray in endless fog with quadrature. A small light is at the
/// distance `ahead` along the ray, and at the distance `aside` from the ray. `error`: the largest
/// standard error that is accepted, relative to the expected value.
void expect_single_scattering(const Medium& fog, double ahead, double aside, double error,
                              std::uint64_t samples = 1024) {
  constexpr double kRadius = 1e-6;  // so small that the light is practically a point
  constexpr float kRadiance = 1e12f;
  SceneMaker maker;
  maker.sphere({ahead, aside, 0}, kRadius, maker.lamp(kRadiance));
  test::fog(maker, fog);
  const double expected =
      scattered_once(fog, ahead, aside, double{kRadiance} * kPi * kRadius * kRadius);
  const Ray ray{.origin = {0, 0, 0}, .direction = {1, 0, 0}};
  expect_value(test::radiance_along(*maker.build(), ray, {.max_depth = 1}, samples), expected,
               error);
}

TEST(Media, SingleScatteringEqualsQuadrature) {
  expect_single_scattering(medium(0.1f, 0.4f), 2, 1, 1e-3);
  expect_single_scattering(medium(0.3f, 1, 0.7), 1, 0.5, 1e-3);
  expect_single_scattering(medium(0, 0.05f, -0.5), 3, 0.05, 1e-3);
  expect_single_scattering(medium(0.2f, 3), -0.4, 0.3, 1e-3);
}

TEST(Media, ScatterDeltaLights) {
  const Medium smoke = medium(0.1f, 0.4f, 0.3);
  const Ray ray{.origin = {0, 0, 0}, .direction = {1, 0, 0}};
  SceneMaker point;
  test::fog(point, smoke);
  point.scene.lights = {PointLight{{2, 0.7, 0}, gray(5)}};
  expect_value(test::radiance_along(*point.build(), ray, {.max_depth = 1}, 1024),
               scattered_once(smoke, 2, 0.7, 5), 1e-3);

  // The sun directly above a slab that is viewed from above: the light goes in and back out.
  SceneMaker sun;
  const MediumId inside = test::add(sun, medium(0.2f, 0.6f));
  test::fill_box(sun, {-1e6, 0, -1e6}, {1e6, 2, 1e6}, inside);
  sun.scene.lights = {DirectionalLight{{0, -1, 0}, gray(7)}};
  const Ray down{.origin = {0, 5, 0}, .direction = {0, -1, 0}};
  const double expected = 0.6 * 7 / (4 * kPi) * -std::expm1(-2 * 0.8 * 2) / (2 * 0.8);
  expect_value(test::radiance_along(*sun.build(), down, {.max_depth = 1}, 1024), expected, 1e-3);
}

/// Returns the singly scattered radiance along x for a light in isotropic fog.
double scattered_once(const Medium& fog, const DeltaLight& light) {
  const double sigma = double{fog.absorption.g} + fog.scattering.g;
  return integral([&](double s) {
    const Arrival arrives = std::visit(
        [&](const auto& l) {
          return arrival(l, {}, {s, 0, 0});
        },
        light);
    return fog.scattering.g / (4 * kPi) * std::exp(-sigma * (s + length(arrives.to_light))) *
           arrives.irradiance.g;
  });
}

/// A ray crosses the cone of a spot light close to its tip, but most of the light along the ray is
/// scattered elsewhere. Samples near the tip must not be far too bright (fireflies), so the
/// standard error is bounded.
TEST(Media, ScatterASpotAmongOtherLightsWithoutFireflies) {
  const Medium smoke = medium(0.02f, 0.1f);
  SceneMaker maker;
  test::fog(maker, smoke);
  maker.scene.lights = {SpotLight{{2, 0.02, 0}, {0, -1, 0}, gray(1), 0.97, 0.94}};
  for (const double x : {-1.0, 3.0, 5.0, 7.0, 9.0}) {
    maker.scene.lights.push_back(PointLight{{x, 4, 1}, gray(1)});
  }
  double expected = 0;
  for (const DeltaLight& light : maker.scene.lights) {
    expected += scattered_once(smoke, light);
  }
  const Ray ray{.origin = {0, 0, 0}, .direction = {1, 0, 0}};
  expect_value(test::radiance_along(*maker.build(), ray, {.max_depth = 1}, 1024), expected, 1e-2);
}

/// The ball is 2e12 mean free paths wide. Paths in it end because the depth is limited.
TEST(Media, V3V11PathsInAnOpaqueBallEndAtTheMaximumDepth) {
  SceneMaker maker = white_sky();
  test::fill_sphere(maker, {0, 0, 0}, 1, test::add(maker, medium(0, 1e12f)));
  const auto scene = maker.build();
  const Ray ray{.origin = {-2, 0, 0}, .direction = {1, 0, 0}};
  double last = 0;
  for (const std::uint32_t depth : {1u, 8u, 64u, 512u}) {
    const Moments seen = test::radiance_along(*scene, ray, {.max_depth = depth}, 256);
    EXPECT_GT(seen.mean(), last);
    EXPECT_LE(seen.mean(), 1 + 4 * seen.standard_error());
    last = seen.mean();
  }
  EXPECT_GT(last, 0.9);
  PathCounts counts;
  for (std::uint64_t sample = 0; sample < 64; ++sample) {
    path_radiance(*scene, ray, PixelSampler(3, 1, 2), sample, {.max_depth = 8}, counts);
  }
  EXPECT_GT(counts.truncated, 0u);
  EXPECT_LE(counts.truncated, 64u);
  test::report_hard_case("V11", "paths that end at the maximum depth are counted as cut off");
  test::report_hard_case("V3", "opaque ball: every path ends by the maximum depth");
  test::at_least("V11",
                 "radiance of a ball with scattering coefficient 1e12, with at most 512 bounces",
                 last, 0.9);
}

/// A closed shape whose medium does not absorb is invisible under a white sky. Its pixels have no
/// noise.
TEST(Media, O8WithoutLossAreInvisibleInAWhiteSky) {
  for (const double g : {0.0, 0.8, -0.5}) {
    SceneMaker ball = white_sky();
    test::fill_sphere(ball, {0, 0, 0}, 1, test::add(ball, medium(0, 3, g)));
    const Ray ray{.origin = {-2, 0.3, 0}, .direction = {1, 0, 0}};
    const Moments seen = test::radiance_along(*ball.build(), ray, {.max_depth = 1000}, 256, 8);
    EXPECT_NEAR(seen.mean(), 1, 1e-5);
    EXPECT_LE(seen.standard_error(), 1e-5);
  }
  // A slab thinner than any fixed step.
  SceneMaker thin = white_sky();
  test::fill_box(thin, {-9, 0, -9}, {9, 1e-5, 9}, test::add(thin, medium(0, 1e5f)));
  const Ray down{.origin = {0, 4, 0}, .direction = normalize({0.3, -1, 0.1})};
  expect_value(test::radiance_along(*thin.build(), down, {.max_depth = 1000}, 256, 8), 1, 1e-5);
  test::report_hard_case("O8", "a medium without absorption is invisible in a white sky");
}

/// A slab as thin as that of the previous test absorbs according to its thickness.
TEST(Media, O8ThinSlabIsNotSteppedOver) {
  SceneMaker maker = white_sky();
  test::fill_box(maker, {-9, 0, -9}, {9, 1e-5, 9}, test::add(maker, medium(1e5f, 0)));
  const Ray down{.origin = {0, 4, 0}, .direction = {0, -1, 0}};
  EXPECT_NEAR(one_sample(*maker.build(), down), std::exp(-1.0), 1e-6);
  test::report_hard_case("O8", "transmittance of a thin slab follows the exponential law");
}

/// A pane whose two faces lie exactly in the boundary of an absorbing medium. Each face reflects
/// the share f = 0.04, and the medium transmits the share t. `through` and `back` are the sums over
/// all reflections between the faces.
TEST(Media, V9InAPaneOfGlassAbsorbBetweenReflections) {
  SceneMaker maker = white_sky();
  const MaterialId glass = maker.glass(1.5);
  maker.quad({-9, 1, -9}, {0, 0, 18}, {18, 0, 0}, glass);
  maker.quad({-9, 0, -9}, {18, 0, 0}, {0, 0, 18}, glass);
  test::fill_box(maker, {-9, 0, -9}, {9, 1, 9}, test::add(maker, medium(0.6f, 0)));
  const double f = 0.04;
  const double t = std::exp(-0.6);
  const double through = (1 - f) * (1 - f) * t / (1 - f * f * t * t);
  const double back = f + f * (1 - f) * (1 - f) * t * t / (1 - f * f * t * t);
  const Ray up{.origin = {0.2, -3, 0.1}, .direction = {0, 1, 0}};
  expect_value(test::radiance_along(*maker.build(), up, {.max_depth = 1000}, 4096), through + back,
               1e-3);
  test::report_hard_case("V9", "medium in a pane: light within 4 SE of the closed form");
}

/// A filled glass ball, viewed through its middle. The surface reflects the share f = 0.04 at each
/// hit, and the medium transmits the share t of each crossing. The light that enters leaves on both
/// sides; `through` is the sum over all crossings.
TEST(Media, V9InAGlassBallAbsorbBetweenReflections) {
  SceneMaker maker = white_sky();
  maker.sphere({0, 0, 0}, 1, maker.glass(1.5));
  test::fill_sphere(maker, {0, 0, 0}, 1, test::add(maker, medium(0.3f, 0)));
  const double f = 0.04;
  const double t = std::exp(-0.6);
  const double through = (1 - f) * (1 - f) * t / (1 - f * t);
  const Ray ray{.origin = {-3, 0, 0}, .direction = {1, 0, 0}};
  expect_value(test::radiance_along(*maker.build(), ray, {.max_depth = 1000}, 4096), f + through,
               1e-3);
  test::report_hard_case("V9", "medium in a glass ball: light within 4 SE of the closed form");
}

/// Returns a scene with a floor, two lamps, and a ball of smoke inside a box of smoke. The smoke is
/// anisotropic, and the smoke of the box is coloured. `with_fog`: fog fills the rest of space.
std::shared_ptr<const Scene> smoky_room(bool with_fog) {
  SceneMaker maker;
  maker.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, maker.diffuse(0.6f));
  maker.quad({-0.5, 3, -0.5}, {1, 0, 0}, {0, 0, 1}, maker.lamp(8));
  maker.sphere({1.2, 1, 0.4}, 0.4, maker.lamp(3));
  if (with_fog) {
    test::fog(maker, {.absorption = {0.05f, 0.02f, 0}, .scattering = {0.1f, 0.15f, 0.3f}});
  }
  const MediumId outer =
      test::add(maker, {.absorption = {0, 0.3f, 1}, .scattering = {0.2f, 0.7f, 3}, .g = 0.5});
  const MediumId inner = test::add(maker, medium(0.5f, 2, -0.3));
  test::fill_box(maker, {-1.5, 0, -1}, {1.5, 1.5, 1}, outer);
  test::fill_sphere(maker, {0, 1, 0}, 0.6, inner);
  return maker.build();
}

TEST(MediaTechniques, AllTechniquesHaveTheSameMean) {
  for (const bool with_fog : {false, true}) {
    const auto scene = smoky_room(with_fog);
    for (const Vec3& target : {Vec3{0, 1, 0}, Vec3{-1.2, 0.2, 0.5}, Vec3{0.7, 1.6, 0}}) {
      const Vec3 eye{0.3, 1.4, 3.5};
      const Ray ray{.origin = eye, .direction = normalize(target - eye)};
      const auto mean = [&](Technique technique) {
        return test::radiance_along(*scene, ray, {.max_depth = 4, .technique = technique}, 1024);
      };
      const Moments both = mean(Technique::kBoth);
      EXPECT_LE(both.standard_error(), 8e-3 * both.mean());
      for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
        const Moments single = mean(technique);
        const double error = std::hypot(single.standard_error(), both.standard_error());
        EXPECT_LE(std::abs(single.mean() - both.mean()), 4 * error)
            << "both " << both.mean() << ", one " << single.mean() << " +- " << error;
        EXPECT_LE(single.standard_error(), 0.08 * both.mean());
      }
    }
  }
}

TEST(MediaTechniques, R8_RouletteKeepsTheMean) {
  const auto scene = smoky_room(/*with_fog=*/true);
  const Ray ray{.origin = {0.3, 1.4, 3.5}, .direction = normalize({-0.3, -0.4, -3.5})};
  const Moments with = test::radiance_along(*scene, ray, {.max_depth = 20}, 512);
  const Moments without =
      test::radiance_along(*scene, ray, {.max_depth = 20, .russian_roulette = false}, 512);
  const double error = std::hypot(with.standard_error(), without.standard_error());
  EXPECT_LE(std::abs(with.mean() - without.mean()), 4 * error);
  EXPECT_LE(error, 1e-2 * with.mean());
  test::report_hard_case("R8", "means with and without roulette are equal within 4 SE");
}

/// A medium without absorption and scattering changes no bit of the radiance.
TEST(Media, V1EmptyMediaChangeNoBit) {
  SceneMaker without;
  without.quad({-4, 0, -4}, {0, 0, 8}, {8, 0, 0}, without.diffuse(0.6f));
  without.quad({-0.5, 3, -0.5}, {1, 0, 0}, {0, 0, 1}, without.lamp(8));
  without.sphere({1.2, 1, 0.4}, 0.4, without.glass(1.5));
  SceneMaker with = without;
  test::fill_box(with, {-1.5, -1, -1}, {1.5, 1.5, 1}, test::add(with, {}));
  const Ray ray{.origin = {0.3, 1.4, 3.5}, .direction = normalize({0.2, -0.2, -1})};
  const Moments seen = test::radiance_along(*with.build(), ray, {.max_depth = 8}, 256);
  EXPECT_GT(seen.mean(), 0);
  EXPECT_EQ(seen.mean(), test::radiance_along(*without.build(), ray, {.max_depth = 8}, 256).mean());
}

TEST(MediaTechniques, AgreeUnderAnUnevenSky) {
  SceneMaker maker;
  test::fill_sphere(maker, {0, 0, 0}, 1, test::add(maker, medium(0.1f, 1.5f, 0.6)));
  maker.sphere({2, 0, 1}, 0.5, maker.lamp(2));
  Environment environment;
  environment.images = {maker.texture(test::float_image(8, 4, [](auto x, auto y) {
    return x == 2 && y == 1 ? 20.0f : 0.1f * static_cast<float>(y);
  }))};
  maker.scene.background.environment = environment;
  const auto scene = maker.build();
  const Ray ray{.origin = {0.2, 0.3, 4}, .direction = normalize({-0.05, -0.1, -1})};
  const auto mean = [&](Technique technique) {
    return test::radiance_along(*scene, ray, {.max_depth = 3, .technique = technique}, 2048);
  };
  const Moments both = mean(Technique::kBoth);
  EXPECT_LE(both.standard_error(), 1e-2 * both.mean());
  for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
    const Moments single = mean(technique);
    const double error = std::hypot(single.standard_error(), both.standard_error());
    EXPECT_LE(std::abs(single.mean() - both.mean()), 4 * error)
        << "both " << both.mean() << ", one " << single.mean() << " +- " << error;
    EXPECT_LE(single.standard_error(), 0.1 * both.mean());
  }
}

/// The camera ray goes through the centre of a light. MIS and light sampling have the same mean.
TEST(MediaTechniques, V8AgreeOnARayThroughTheMiddleOfALight) {
  SceneMaker maker;
  maker.sphere({3, 0, 0}, 0.1, maker.lamp(50));
  test::fog(maker, medium(0.05f, 0.2f));
  const auto scene = maker.build();
  const Ray ray{.origin = {0, 0, 0}, .direction = {1, 0, 0}};
  const auto mean = [&](Technique technique) {
    return test::radiance_along(*scene, ray, {.max_depth = 1, .technique = technique}, 4096);
  };
  const Moments both = mean(Technique::kBoth);
  const Moments lights = mean(Technique::kLightsOnly);
  EXPECT_LE(both.standard_error(), 1e-3 * both.mean());
  EXPECT_LE(std::abs(both.mean() - lights.mean()),
            4 * std::hypot(both.standard_error(), lights.standard_error()));
  test::report_hard_case("V8", "light sampling alone equals both techniques together within 4 SE");
}

}  // namespace
}  // namespace bandsaw
