// Compares the irradiance under triangles with Lambert's formula for polygons. An id such as X9 in
// a test's name is that of a case in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

constexpr Vec3 kUp{0, 1, 0};

/// Returns E / L at the origin with normal `n` for a polygon above the horizon, by Lambert's
/// formula. Each edge adds the angle that it subtends, times the cosine between `n` and the normal
/// of the plane through the origin and the edge. E / L is half of this sum.
double irradiance_of(const std::vector<Vec3>& corners, const Vec3& n) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 a = normalize(corners[i]);
    const Vec3 b = normalize(corners[(i + 1) % corners.size()]);
    sum += std::atan2(length(cross(a, b)), dot(a, b)) * dot(normalize(cross(a, b)), n);
  }
  return std::abs(sum) / 2;
}

/// Adds a white diffuse patch at the origin with normal +y, and expects its irradiance within 4
/// standard errors.
void expect_irradiance(SceneMaker maker, double expected, std::uint64_t samples = 1024) {
  maker.quad({-0.001, 0, -0.001}, {0, 0, 0.002}, {0.002, 0, 0}, maker.diffuse(1));
  const auto scene = maker.build();
  const Ray down{.origin = {0, 1e-4, 0}, .direction = -kUp};
  const Moments radiance = test::radiance_along(*scene, down, {.max_depth = 1}, samples);
  const double value = expected / kPi;
  EXPECT_NEAR(radiance.mean(), value, 4 * radiance.standard_error() + 2e-6 * value);
  EXPECT_LE(radiance.standard_error(), 1e-3 * value);
}

TEST(PolygonLight, TheFormulaGivesTheKnownValuesOfASquare) {
  const auto square = [](double h) {
    return std::vector<Vec3>{{-1, h, -1}, {1, h, -1}, {1, h, 1}, {-1, h, 1}};
  };
  EXPECT_NEAR(irradiance_of(square(0.1), kUp), 3.116100618403, 1e-10);
  EXPECT_NEAR(irradiance_of(square(1), kUp), 1.740839502734, 1e-10);
  EXPECT_NEAR(irradiance_of(square(5), kUp), 0.151918069683, 1e-10);
}

TEST(PolygonLight, TrianglesOfAnySizeAndSlantMeetTheFormula) {
  const std::vector<std::vector<Vec3>> all = {
      {{-2, 1, -1}, {2, 1.5, -1}, {0.5, 1, 3}},          // large
      {{-9, 0.1, -9}, {9, 0.1, -9}, {0, 0.1, 14}},       // nearly all of the sky
      {{1, 0.05, -1}, {1, 2, 0}, {1, 0.05, 1}},          // upright, close
      {{3, 2, 0}, {3.1, 2, 0}, {3, 2.1, 0.1}},           // small, so sampled by its area
      {{-4, 0.5, 1}, {4, 0.5, 1}, {4, 0.52, 1}},         // thin
      {{0.02, 0.03, 0}, {0.5, 2, 0.7}, {-0.8, 3, 0.2}},  // a corner near the receiver
  };
  for (const auto& t : all) {
    SceneMaker maker;
    maker.triangle(t[0], t[1], t[2], maker.lamp(1));
    expect_irradiance(maker, irradiance_of(t, kUp), 4096);
  }
}

// An occluder is halfway to the light, and its edge is in front of the light. The visible part of
// the light counts.
TEST(PolygonLight, APartlyOccludedLightCountsByItsVisiblePart) {
  for (const double edge : {-0.6, 0.1, 0.9}) {
    SceneMaker maker;
    maker.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(1));
    maker.quad({edge / 2, 0.5, -4}, {4, 0, 0}, {0, 0, 8}, maker.diffuse(0));
    expect_irradiance(
        maker, irradiance_of({{-1, 1, -1}, {edge, 1, -1}, {edge, 1, 1}, {-1, 1, 1}}, kUp), 8192);
  }
}

TEST(PolygonLight, X9AnInstanceEmitsAccordingToItsPlacedArea) {
  const double expected = 1.740839502734;  // of a square of side 2 at height 1
  for (const int n : {1, 8}) {             // few lights, and many
    for (const double scale : {1e-3, 1e3}) {
      SceneMaker maker;
      Mesh mesh = test::grid(n);
      for (auto& p : mesh.positions) {
        p = {static_cast<float>(p[0] / scale), static_cast<float>(p[1] / scale), 0};
      }
      maker.instance(
          mesh, translation({0, 1, 0}) * rotation({1, 0, 0}, 90) * scaling({scale, -scale, scale}),
          maker.lamp(1));
      expect_irradiance(maker, expected, n == 1 ? 1024 : 8192);
    }
  }
}

TEST(PolygonLight, L12LightsCountOnceForEveryTechnique) {
  // The scene has a light of triangles, a mirror ball and a glass ball. Each technique has the same
  // mean.
  SceneMaker maker;
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.diffuse(0.5f));
  maker.instance(test::grid(4), translation({0, 2, -1}) * rotation({1, 0, 0}, 60), maker.lamp(3));
  maker.sphere({-1.2, 0.6, 0.3}, 0.6, maker.metal(0.9f, 0));
  maker.sphere({1.2, 0.6, 0.3}, 0.6, maker.glass(1.5));
  const auto scene = maker.build();
  for (const Vec3& target :
       {Vec3{0, 2, -1}, Vec3{-1.2, 0.9, 0.7}, Vec3{1.2, 0.7, 0.8}, Vec3{0, 0, 0.5}}) {
    const Vec3 eye{0, 2, 6};
    const Ray ray{.origin = eye, .direction = normalize(target - eye)};
    const Moments both = test::radiance_along(*scene, ray, {.max_depth = 6}, 4096);
    for (const Technique technique : {Technique::kLightsOnly, Technique::kScatteringOnly}) {
      const Moments alone =
          test::radiance_along(*scene, ray, {.max_depth = 6, .technique = technique}, 8192);
      const double error = std::hypot(both.standard_error(), alone.standard_error());
      EXPECT_LE(std::abs(both.mean() - alone.mean()), 4 * error + 1e-6)
          << static_cast<int>(technique);
    }
  }
  test::report_hard_case("L12", "each technique alone equals both together within 4 SE");
}

}  // namespace
}  // namespace bandsaw
