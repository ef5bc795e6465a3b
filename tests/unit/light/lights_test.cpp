// Samples of area lights of many shapes, with their pdfs, radiances and visibility. An id such as
// O4 in a test's name is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/light/lights.h"

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/light/emission.h"
#include "renderlib/math/elementary.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Random;
using test::SceneMaker;

/// A scene with lights.
struct Case {
  std::string name;
  SceneMaker maker;
};

/// Returns an image of four texels in a row, each brighter than the one before.
Texture stripes() {
  ImageTexture image;
  image.width = 4;
  image.height = 1;
  std::vector<std::byte> texels;
  for (int i = 0; i < 12; ++i) {
    texels.push_back(std::byte(20 + 17 * i));
  }
  image.texels = std::move(texels);
  return image;
}

/// Area lights of many shapes, seen from points of the plane y = 0 near the origin.
std::vector<Case> cases() {
  std::vector<Case> all;
  const auto add = [&](const std::string& name, auto build) {
    SceneMaker maker;
    build(maker);
    all.push_back({name, maker});
  };
  add("sphere", [](auto& m) { m.sphere({0.5, 2, 0}, 1, m.lamp(1)); });
  add("sphere across the horizon", [](auto& m) { m.sphere({1.5, 0.2, 0}, 0.8, m.lamp(1)); });
  add("small far sphere", [](auto& m) { m.sphere({300, 900, 20}, 0.01, m.lamp(1)); });
  add("inside a sphere", [](auto& m) { m.sphere({0.1, 0.4, 0}, 3, m.lamp(1)); });
  add("rectangle", [](auto& m) { m.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, m.lamp(1)); });
  add("near rectangle", [](auto& m) { m.quad({-1, 1e-3, -1}, {2, 0, 0}, {0, 0, 2}, m.lamp(1)); });
  add("upright rectangle", [](auto& m) { m.quad({1, -1, -1}, {0, 0, 2}, {0, 2, 0}, m.lamp(1)); });
  add("parallelogram", [](auto& m) { m.quad({-1, 1, -1}, {2, 0.3, 1}, {0, 0, 2}, m.lamp(1)); });
  add("triangle", [](auto& m) { m.triangle({-2, 1, -1}, {2, 1.5, -1}, {0.5, 1, 3}, m.lamp(1)); });
  add("mirrored mesh", [](auto& m) {
    m.instance(test::grid(1),
               translation({0, 1, 0}) * rotation({1, 0, 0}, 100) * scaling({-1, 3, 1}), m.lamp(1));
  });
  add("textured", [](auto& m) {
    const TextureId texture = m.texture(stripes());
    const MaterialId lamp = m.material(Emissive{texture, false});
    m.quad({-1, 1, -1}, {2, 0, 0}, {0, 0, 2}, lamp);
    m.sphere({2, 1, 0}, 0.5, lamp);
    m.instance(test::grid(1), translation({-2, 2, 0}) * rotation({1, 0, 0}, 80), lamp);
  });
  add("many", [](auto& m) {
    m.instance(test::grid(4), translation({0, 1, 0}) * rotation({1, 0, 0}, 70), m.lamp(1));
    m.sphere({3, 1, 0}, 0.5, m.lamp(4));
  });
  return all;
}

constexpr Vec3 kUp{0, 1, 0};

TEST(Lights, SamplesHaveThePdfAndRadianceOfTheirSurface) {
  for (const Case& test_case : cases()) {
    const auto scene = test_case.maker.build();
    Random random(2);
    int samples = 0;
    for (int i = 0; i < 20000; ++i) {
      const Receiver receiver{{random.uniform(-0.3, 0.3), 0, random.uniform(-0.3, 0.3)}, kUp};
      const double choice = random.uniform();
      const double u = random.uniform();
      const auto light = scene->lights().sample(receiver, choice, u, random.uniform());
      if (!light) {
        continue;
      }
      ++samples;
      ASSERT_NEAR(length(light->direction), 1, 1e-14);
      ASSERT_GT(light->direction.y, 0);
      const Ray ray{.origin = receiver.position, .direction = light->direction};
      const Hit hit = scene->accel().closest(ray);
      const SurfacePoint point = hit ? surface_at(scene->geometry(), ray, hit) : SurfacePoint{};
      if (!hit || length(point.position - light->target) > 1e-6 * (1 + length(light->target))) {
        continue;  // an edge, or another light in front
      }
      ASSERT_NEAR(scene->lights().pdf(receiver, point) / light->pdf, 1, 1e-6) << test_case.name;
      const Rgb radiance =
          emitted(scene->material(point.material), scene->textures(), point, -ray.direction);
      ASSERT_NEAR(radiance.g, light->radiance.g, 1e-4) << test_case.name;
    }
    EXPECT_GT(samples, 3000) << test_case.name;
  }
}

TEST(Lights, O4_VisibleSamplesAreNotSelfShadowed) {
  for (const Case& test_case : cases()) {
    if (test_case.name == "textured" || test_case.name == "many") {
      continue;  // these lights occlude each other
    }
    SceneMaker maker = test_case.maker;
    maker.quad({-0.4, 0, -0.4}, {0, 0, 0.8}, {0.8, 0, 0}, maker.diffuse(1));
    const auto scene = maker.build();
    Random random(3);
    int occluded = 0;
    for (int i = 0; i < 100000; ++i) {
      const double x = random.uniform(-0.39, 0.39);
      const Ray down{.origin = {x, 1e-4, random.uniform(-0.39, 0.39)}, .direction = -kUp};
      const SurfacePoint point = surface_at(scene->geometry(), down, scene->accel().closest(down));
      const double choice = random.uniform();
      const double u = random.uniform();
      const auto light = scene->lights().sample({point.position, kUp}, choice, u, random.uniform());
      occluded += light && scene->accel().occluded(spawn_ray_to(point, light->target, 0)) ? 1 : 0;
    }
    EXPECT_EQ(occluded, 0) << test_case.name;
  }
  test::report_hard_case("O4", "0 of 100,000 shadow rays occluded, for each of ten kinds of light");
}

// Counts samples in cells of equal solid angle above the plane y = 0. Each count must agree with
// the integral of the pdf over the cell. The integral is computed as a sum over kSteps x kSteps
// directions.
TEST(Lights, DirectionsFollowThePdf) {
  constexpr int kRings = 12;
  constexpr int kSectors = 16;
  constexpr int kSteps = 24;
  constexpr int kSamples = 100000;
  for (const Case& test_case : cases()) {
    if (test_case.name == "small far sphere" || test_case.name == "near rectangle" ||
        test_case.name == "many" || test_case.name == "textured") {
      continue;  // too small for the cells, or not the first surface in every direction
    }
    const auto scene = test_case.maker.build();
    const Receiver receiver{{0.05, 0, 0.1}, kUp};
    std::vector<std::uint64_t> counts(kRings * kSectors + 1);
    std::vector<double> expected(counts.size());
    Random random(4);
    for (int i = 0; i < kSamples; ++i) {
      const double choice = random.uniform();
      const double u = random.uniform();
      const auto light = scene->lights().sample(receiver, choice, u, random.uniform());
      std::size_t cell = counts.size() - 1;
      if (light) {
        const Vec3& d = light->direction;
        const double turn = std::atan2(d.z, d.x) / (2 * kPi) + 0.5;
        cell =
            std::min<std::size_t>(kRings - 1, static_cast<std::size_t>(d.y * kRings)) * kSectors +
            std::min<std::size_t>(kSectors - 1, static_cast<std::size_t>(turn * kSectors));
      }
      ++counts[cell];
    }
    const double step_angle = 2 * kPi / (kRings * kSectors * kSteps * kSteps);
    double inside = 0;
    for (int a = 0; a < kRings * kSteps; ++a) {
      for (int b = 0; b < kSectors * kSteps; ++b) {
        const double y = (a + 0.5) / (kRings * kSteps);
        const SinCos turn = sincos_turns((b + 0.5) / (kSectors * kSteps) - 0.5);
        const double r = std::sqrt(1 - y * y);
        const Ray ray{.origin = receiver.position, .direction = {r * turn.cos, y, r * turn.sin}};
        const Hit hit = scene->accel().closest(ray);
        if (hit) {
          const double pdf = scene->lights().pdf(receiver, surface_at(scene->geometry(), ray, hit));
          expected[static_cast<std::size_t>(a / kSteps * kSectors + b / kSteps)] +=
              kSamples * pdf * step_angle;
          inside += pdf * step_angle;
        }
      }
    }
    EXPECT_LT(inside, 1.005) << test_case.name;
    expected.back() = kSamples * std::max(0.0, 1 - inside);
    if (expected.back() < kSamples * 0.005) {
      // The pdf integrates to 1, up to the error of the sum over directions. So every sample must
      // find a light.
      expected.back() = 0;
      EXPECT_EQ(counts.back(), 0u) << test_case.name;
    }
    EXPECT_GT(test::chi_squared(counts, expected).p_value, test::sidak(0.01, 8)) << test_case.name;
  }
}

TEST(Lights, SelectionFrequenciesEqualProbabilities) {
  SceneMaker maker;
  Random random(8);
  const int count = 200;
  for (int i = 0; i < count; ++i) {
    // The numbers are drawn one by one, because the evaluation order of arguments is unspecified.
    const double x = random.uniform(-9, 9);
    const double z = random.uniform(-9, 9);
    const double power = std::exp2(random.uniform(-6, 2));
    maker.sphere({x, 1 + 0.3 * i, z}, 0.1, maker.lamp(static_cast<float>(power)));
  }
  const auto scene = maker.build();
  const Receiver receiver{{0, 0, 0}, kUp};
  std::vector<std::uint64_t> counts(count);
  std::vector<double> expected(count);
  constexpr int kSamples = 200000;
  double sum = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double probability = scene->lights().probability(receiver, {0, i});
    EXPECT_GT(probability, 0);
    expected[i] = kSamples * probability;
    sum += probability;
  }
  EXPECT_NEAR(sum, 1, 1e-12);
  for (int i = 0; i < kSamples; ++i) {
    const double choice = static_cast<double>(random.bits() >> 32) * 0x1p-32;
    const auto light = scene->lights().sample(receiver, choice, 0.5, 0.5);
    ASSERT_TRUE(light);
    for (std::uint32_t k = 0; k < count; ++k) {
      const Sphere& sphere = scene->geometry().spheres[k];
      if (length(light->target - sphere.center) < 0.11) {
        ++counts[k];
        break;
      }
    }
  }
  EXPECT_GT(test::chi_squared(counts, expected).p_value, 0.001);
}

TEST(Lights, L1T4_SurfacesWithoutAreaOrPowerAreNoLights) {
  SceneMaker maker;
  maker.sphere({0, 2, 0}, 1, maker.lamp(0));
  maker.quad({0, 1, 0}, {1, 0, 0}, {2, 0, 0}, maker.lamp(5));
  EXPECT_TRUE(maker.build()->lights().empty());
  maker.sphere({0, 9, 0}, 1, maker.lamp(1));
  const auto scene = maker.build();
  EXPECT_EQ(scene->lights().size(), 1u);
  // A primitive is identified by the numbers of its instance and of its shape. There is no
  // instance 7.
  EXPECT_EQ(scene->lights().probability({{0, 0, 0}, kUp}, {0, 0}), 0);
  EXPECT_EQ(scene->lights().probability({{0, 0, 0}, kUp}, {0, 1}), 1);
  EXPECT_EQ(scene->lights().probability({{0, 0, 0}, kUp}, {7, 1}), 0);
  test::report_hard_case("L1", "surfaces without area or power are not in the list of lights");
  test::report_hard_case("T4", "a quad without area is no light");
}

TEST(Lights, L11_OneSidedLightsEmitOnlyToTheirFront) {
  for (const bool facing : {true, false}) {
    SceneMaker maker;
    const Vec3 u{2, 0, 0};
    const Vec3 v{0, 0, 2};
    maker.quad({-1, 1, -1}, facing ? u : v, facing ? v : u, maker.lamp(1, true));
    const auto scene = maker.build();
    const auto light = scene->lights().sample({{0, 0, 0}, kUp}, 0.5, 0.5, 0.5);
    EXPECT_EQ(light.has_value(), facing);
    const auto from_above = scene->lights().sample({{0, 2, 0}, -kUp}, 0.5, 0.5, 0.5);
    EXPECT_EQ(from_above.has_value(), !facing);
  }
  test::report_hard_case("L11", "a receiver behind the light gets no light sample");
}

TEST(Lights, LightsBelowTheHorizonAreNotSampled) {
  SceneMaker maker;
  maker.sphere({0, -2, 0}, 1, maker.lamp(1000));
  maker.sphere({0, 3, 0}, 1, maker.lamp(1));
  const auto scene = maker.build();
  EXPECT_EQ(scene->lights().probability({{0, 0, 0}, kUp}, {0, 0}), 0);
  EXPECT_EQ(scene->lights().probability({{0, 0, 0}, kUp}, {0, 1}), 1);
}

TEST(Lights, Q6_AReceiverInThePlaneOfALightGetsNoSample) {
  SceneMaker maker;
  maker.quad({1, 0, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(1));
  const auto scene = maker.build();
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const double u = random.uniform();
    EXPECT_FALSE(scene->lights().sample({{0, 0, 0}, kUp}, 0.5, u, random.uniform()));
    EXPECT_FALSE(scene->lights().sample({{1, 0, 0}, kUp}, 0.5, u, random.uniform()));
  }
  test::report_hard_case("Q6",
                         "receivers in the plane of the light get none of 2,000 light samples");
}

}  // namespace
}  // namespace bandsaw
