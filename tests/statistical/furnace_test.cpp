// Compares the light after many bounces with a closed form, in scenes that have a closed form. In
// other scenes, expects that light sampling, BSDF sampling and MIS of both have the same mean. All
// means must lie within 4 standard errors. An id such as O6 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Expects that the mean is `expected` within 4 standard errors. `relative_error`: the largest
/// standard error that is accepted, relative to `expected`.
void expect_value(const Moments& radiance, double expected, double relative_error) {
  EXPECT_LE(std::abs(radiance.z(expected)), 4)
      << "is " << radiance.mean() << " +- " << radiance.standard_error() << ", expected "
      << expected;
  EXPECT_LE(radiance.standard_error(), relative_error * expected);
}

/// A diffuse sphere of radius 1 around a light of radius r in its middle. From every point of the
/// wall, the light covers the share f = r^2 of the cosine-weighted hemisphere, and the wall covers
/// the rest. So the wall has the same radiance everywhere.
SceneMaker enclosure(float reflectance, double f) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1, maker.diffuse(reflectance));
  maker.sphere({0, 0, 0}, std::sqrt(f), maker.lamp(1));
  return maker;
}

const Ray kAtWall{.origin = {0.9, 0, 0}, .direction = {0, 0.8, 0.6}};

TEST(Furnace, CutOffAfterEachNumberOfBouncesIsTheGeometricSum) {
  const float rho = 0.8f;
  const double f = 0.25;
  const auto scene = enclosure(rho, f).build();
  double expected = 0;
  double term = f;
  for (std::uint32_t depth = 1; depth <= 20; ++depth) {
    term *= depth == 1 ? rho : rho * (1 - f);
    expected += term;
    SCOPED_TRACE(depth);
    expect_value(test::radiance_along(*scene, kAtWall, {.max_depth = depth}, 512), expected, 4e-3);
  }
}

TEST(Furnace, WithoutCutOffIsTheClosedForm) {
  for (const float rho : {0.5f, 0.8f}) {
    const double f = 0.25;
    const double expected = rho * f / (1 - rho * (1 - f));
    const auto scene = enclosure(rho, f).build();
    expect_value(test::radiance_along(*scene, kAtWall, {.max_depth = 1000}, 8192), expected, 1e-3);
    expect_value(
        test::radiance_along(*scene, kAtWall, {.max_depth = 1000, .russian_roulette = false}, 2048),
        expected, 2e-3);
  }
}

TEST(Furnace, ASmallLightGivesOneOverOneMinusRho) {
  const float rho = 0.8f;
  const double f = 1e-3;
  const auto scene = enclosure(rho, f).build();
  // The direct light is rho f. Interreflection multiplies it by nearly 1 / (1 - rho). The factor is
  // a little smaller, because the light covers the share f of the hemisphere.
  const double expected = rho * f / (1 - rho * (1 - f));
  expect_value(test::radiance_along(*scene, kAtWall, {.max_depth = 1000}, 16384), expected, 1e-3);
}

TEST(Furnace, AWhiteSphereUnderAGradientSkyHasTheClosedForm) {
  // The sky has the radiance (1 + cos(a)) / 2, where a is the angle to +y. Under it, a white patch
  // with the normal n has the radiance 1/2 + n.y / 3.
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1, maker.diffuse(1));
  maker.background(gray(0), gray(1));
  const auto scene = maker.build();
  for (const double angle : {0.0, 0.7, 1.6, 3.0}) {
    const Vec3 n{std::sin(angle), std::cos(angle), 0};
    const Ray ray{.origin = n * 2, .direction = -n};
    expect_value(test::radiance_along(*scene, ray, {}, 1024), 0.5 + n.y / 3, 1e-3);
  }
}

TEST(Furnace, O6_APaneOfGlassTransmitsTheSumOverItsReflections) {
  SceneMaker maker;
  const MaterialId glass = maker.glass(1.5);
  maker.quad({-9, 1, -9}, {0, 0, 18}, {18, 0, 0}, glass);
  maker.quad({-9, 0.9, -9}, {18, 0, 0}, {0, 0, 18}, glass);
  maker.background(gray(0), gray(1));
  const Ray up{.origin = {0, 0, 0}, .direction = {0, 1, 0}};
  // (1 - R) / (1 + R) with the reflectance R = 0.04 of a face: the sum over all reflections.
  expect_value(test::radiance_along(*maker.build(), up, {.max_depth = 1000}, 4096), 0.9230769231,
               1e-3);
  test::report_hard_case("O6", "pane of thickness 0.1: transmitted share within 1e-3");
}

/// Diffuse, glossy and glass surfaces under a sphere, a rectangle and a mesh that emit light.
std::shared_ptr<const Scene> mixed(double fuzz) {
  SceneMaker maker;
  maker.quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, maker.metal(0.8f, fuzz));
  maker.quad({-3, 0, -3}, {6, 0, 0}, {0, 6, 0}, maker.diffuse(0.6f));
  maker.sphere({0.8, 1, -1}, 0.7, maker.diffuse(0.4f));
  maker.sphere({-1.5, 2, -1}, 0.8, maker.lamp(3));
  maker.quad({-1, 4, -2}, {2, 0, 0}, {0, 0, 2}, maker.lamp(2));
  maker.instance(test::grid(1), translation({2.9, 1.5, -1.5}) * rotation({0, 1, 0}, 70),
                 maker.lamp(1));
  maker.background(gray(0.1f), gray(0.3f));
  return maker.build();
}

TEST(Techniques, AllTechniquesHaveTheSameMean) {
  for (const double fuzz : {0.3, 1.0}) {
    const auto scene = mixed(fuzz);
    for (const Vec3& target : {Vec3{0, 0, -1}, Vec3{-0.5, 2.5, -3}, Vec3{0.8, 1.2, -1}}) {
      const Vec3 eye{0.2, 1.5, 4};
      const Ray ray{.origin = eye, .direction = normalize(target - eye)};
      const auto mean = [&](Technique technique) {
        return test::radiance_along(*scene, ray, {.max_depth = 4, .technique = technique}, 2048);
      };
      const Moments both = mean(Technique::kBoth);
      EXPECT_LE(both.standard_error(), 5e-3 * both.mean());
      for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
        const Moments single = mean(technique);
        const double error = std::hypot(single.standard_error(), both.standard_error());
        EXPECT_LE(std::abs(single.mean() - both.mean()), 4 * error)
            << "both " << both.mean() << ", one " << single.mean() << " +- " << error;
        EXPECT_LE(single.standard_error(), 0.05 * both.mean());
      }
    }
  }
}

TEST(Techniques, Q5_NearALightMisIsCloseToTheBetterTechnique) {
  // The points are below a 2 x 2 light: close to it, BSDF sampling has hardly any noise; far from
  // it, light sampling has hardly any. (If lights were sampled by area, the standard deviation at
  // the nearest point would be 32 times the mean.)
  for (const double h : {0.02, 0.3, 3.0}) {
    SceneMaker maker;
    maker.quad({-0.01, 0, -0.01}, {0, 0, 0.02}, {0.02, 0, 0}, maker.diffuse(1));
    maker.quad({-1, h, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(1));
    const auto scene = maker.build();
    const Ray down{.origin = {0, 1e-3, 0}, .direction = {0, -1, 0}};
    // Returns the relative standard deviation of a single sample, from one sample of each of many
    // seeds.
    const auto spread = [&](Technique technique) {
      const Moments moments =
          test::radiance_along(*scene, down, {.max_depth = 1, .technique = technique}, 1, 20000);
      return std::sqrt(moments.variance()) / moments.mean();
    };
    const double lights = spread(Technique::kLightsOnly);
    const double scattering = spread(Technique::kScatteringOnly);
    const double both = spread(Technique::kBoth);
    EXPECT_LE(both, std::min(lights, scattering) + 0.25) << h;
    EXPECT_LE(both, std::max(lights, scattering)) << h;
    std::ostringstream figure;
    figure << "h = " << h << ": standard deviation / mean is " << both << " for MIS, " << lights
           << " for light sampling, " << scattering << " for BSDF sampling";
    test::report_hard_case("Q5", figure.str());
  }
}

}  // namespace
}  // namespace bandsaw
