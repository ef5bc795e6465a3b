// Path tracing of scenes in which the radiance along a ray is known exactly. Tests emitters,
// mirrors, glass, depth limits and counters. An id such as L11 in a test's name is that of a case
// in tests/hard_cases/cases.txt.

#include "renderlib/integrate/path.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/hard_case.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

/// Returns the radiance along `ray` of the sample with the number `sample`.
Rgb trace(const Scene& scene, const Ray& ray, std::uint64_t sample, const PathOptions& options) {
  PathCounts counts;
  return path_radiance(scene, ray, PixelSampler(1, 2, 3), sample, options, counts);
}

const Ray kAhead{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};

/// Expects each sample of the ray to have the value `expected`, with each technique. Paths may be
/// random, but their value must not be.
void expect_always(const Scene& scene, const Ray& ray, double expected, double tolerance,
                   std::uint32_t max_depth = 64) {
  for (const Technique technique :
       {Technique::kBoth, Technique::kLightsOnly, Technique::kScatteringOnly}) {
    for (std::uint64_t sample = 0; sample < 200; ++sample) {
      const Rgb value = trace(scene, ray, sample, {max_depth, technique});
      ASSERT_NEAR(value.g, expected, tolerance) << sample;
    }
  }
}

TEST(Path, AnEmitterHasItsRadiance) {
  SceneMaker maker;
  maker.sphere({0, 0, 0}, 1, maker.lamp(7));
  expect_always(*maker.build(), kAhead, 7, 0);
}

TEST(Path, L11_AOneSidedEmitterIsBlackFromBehind) {
  SceneMaker front;
  front.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, front.lamp(7, true));
  expect_always(*front.build(), kAhead, 7, 0);
  SceneMaker back;
  back.quad({-1, -1, 0}, {0, 2, 0}, {2, 0, 0}, back.lamp(7, true));
  expect_always(*back.build(), kAhead, 0, 0);
  test::report_hard_case("L11", "600 samples of the back are exactly 0");
}

TEST(Path, AMirroredEmitterIsScaledByTheReflectance) {
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.metal(0.5f, 0));
  maker.sphere({0.1, 0.2, 9}, 1, maker.lamp(7));
  expect_always(*maker.build(), kAhead, 3.5, 1e-6);
}

TEST(Path, LosslessSurfacesAreInvisibleInAUniformSky) {
  for (const double x : {0.0, 0.5, 0.9, 0.99, 0.999}) {
    const Ray ray{.origin = {x, 0, 5}, .direction = {0, 0, -1}};
    SceneMaker glass;
    glass.background(gray(1), gray(1));
    glass.sphere({0, 0, 0}, 1, glass.glass(1.5));
    expect_always(*glass.build(), ray, 1, 1e-5, 1000);
    SceneMaker mirror;
    mirror.background(gray(1), gray(1));
    mirror.sphere({0, 0, 0}, 1, mirror.metal(1, 0));
    expect_always(*mirror.build(), ray, 1, 0);
    SceneMaker white;
    white.background(gray(1), gray(1));
    white.sphere({0, 0, 0}, 1, white.diffuse(1));
    expect_always(*white.build(), ray, 1, 0);
  }
}

/// A lamp of radiance 8 behind a row of `count` panes.
std::shared_ptr<const Scene> behind_panes(int count, const ThinDielectric& pane) {
  SceneMaker maker;
  const MaterialId material{static_cast<std::uint32_t>(maker.scene.materials.size())};
  maker.scene.materials.emplace_back(pane);
  for (int i = 0; i < count; ++i) {
    maker.quad({-1, -1, 4 - i * 0.001}, {2, 0, 0}, {0, 2, 0}, material);
  }
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.lamp(8));
  return maker.build();
}

// The last argument of the pane `free` sets free_passage: light that passes the pane does not count
// as scattered. Each pane passes half of the light, so two panes leave 2 of the lamp's radiance 8.
TEST(Path, AFreePassageDoesNotCountTowardsTheDepth) {
  constexpr double kIndex = 1.00001;  // so close to 1 that a pane reflects nothing in float
  const ThinDielectric counted{kIndex, {0, 0, 0}, gray(0.5f)};
  const ThinDielectric free{kIndex, {0, 0, 0}, gray(0.5f), true};
  expect_always(*behind_panes(2, counted), kAhead, 2, 1e-6, /*max_depth=*/2);
  expect_always(*behind_panes(2, counted), kAhead, 0, 0, /*max_depth=*/1);
  expect_always(*behind_panes(2, free), kAhead, 2, 1e-6, /*max_depth=*/1);
  // After the last scattering that counts (max_depth is 1), the path goes on through a pane, but is
  // not reflected by it.
  SceneMaker mirrored;
  mirrored.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, mirrored.metal(1, 0));
  const MaterialId pane{static_cast<std::uint32_t>(mirrored.scene.materials.size())};
  mirrored.scene.materials.emplace_back(free);
  mirrored.quad({-1, -1, 3}, {2, 0, 0}, {0, 2, 0}, pane);
  mirrored.quad({-1, -1, 6}, {2, 0, 0}, {0, 2, 0}, mirrored.lamp(8));
  expect_always(*mirrored.build(), kAhead, 2, 1e-6, /*max_depth=*/1);
  // At most 1000 passages of a path are free.
  const ThinDielectric clear{kIndex, {0, 0, 0}, gray(1), true};
  EXPECT_NEAR(trace(*behind_panes(900, clear), kAhead, 0, {.max_depth = 1}).g, 8, 1e-5);
  EXPECT_EQ(trace(*behind_panes(1100, clear), kAhead, 0, {.max_depth = 1}).g, 0)
      << "the path must end";
}

TEST(Path, ATinyGlassSphereAndAThinPaneAreEnteredAndLeft) {
  for (const double size : {1e-4, 1e-6}) {
    SceneMaker maker;
    maker.background(gray(1), gray(1));
    maker.sphere({0, 0, 0}, size, maker.glass(1.5));
    const Ray ray{.origin = {0.3 * size, 0.2 * size, 1}, .direction = {0, 0, -1}};
    expect_always(*maker.build(), ray, 1, 1e-5, 1000);
  }
  for (const double thickness : {1e-3, 1e-6, 1e-9}) {
    SceneMaker maker;
    maker.background(gray(1), gray(1));
    const MaterialId glass = maker.glass(1.5);
    maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, glass);
    maker.quad({-1, -1, -thickness}, {0, 2, 0}, {2, 0, 0}, glass);
    expect_always(*maker.build(), kAhead, 1, 1e-5, 1000);
  }
}

TEST(Path, RadianceInGlassScalesWithTheSquaredIndex) {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  maker.sphere({0, 0, 0}, 1, maker.glass(1.5));
  const Ray ray{.origin = {0, 0, 0.2}, .direction = {0, 0, -1}};
  expect_always(*maker.build(), ray, 2.25, 1e-5, 1000);
}

TEST(Path, MaxDepthLimitsTheNumberOfScatterings) {
  // Two mirrors face each other, and a lamp is beside them. Every reflection halves the light of
  // the lamp. The ray is reflected three times before it hits the lamp.
  SceneMaker maker;
  const MaterialId mirror = maker.metal(0.5f, 0);
  maker.quad({-9, -9, 0}, {18, 0, 0}, {0, 18, 0}, mirror);
  maker.quad({-9, -9, 2}, {18, 0, 0}, {0, 18, 0}, mirror);
  maker.quad({6.5, -9, -1}, {0, 18, 0}, {0, 0, 9}, maker.lamp(8));
  const auto scene = maker.build();
  const Ray ray{.origin = {0, 0, 1}, .direction = normalize({1, 0, -1})};
  for (std::uint32_t depth = 1; depth <= 5; ++depth) {
    const PathOptions options{.max_depth = depth, .russian_roulette = false};
    EXPECT_EQ(trace(*scene, ray, 0, options).g, depth < 3 ? 0 : 1) << depth;
  }
}

TEST(Path, O3_AShadowIsBlackAtAnyDistanceOfTheLamp) {
  SceneMaker maker;
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.diffuse(1));
  maker.quad({-50, 0.5, -50}, {0, 0, 100}, {100, 0, 0}, maker.diffuse(0));
  maker.sphere({0, 1000, 0}, 10, maker.lamp(1e6f));
  const Ray ray{.origin = {0, 0.1, 0}, .direction = {0, -1, 0}};
  expect_always(*maker.build(), ray, 0, 0);
  test::report_hard_case("O3", "600 samples in the shadow are exactly 0");
}

TEST(Path, TX8_ConstantColorAndConstantTextureGiveTheSameBits) {
  SceneMaker plain;
  const MaterialId gray_plain = plain.diffuse(1);
  SceneMaker textured;
  ImageTexture image;
  image.width = 3;
  image.height = 3;
  image.texels = std::vector<std::byte>(27, std::byte{255});
  textured.scene.materials.push_back(Diffuse{textured.texture(image)});
  const auto finish = [](SceneMaker& maker, MaterialId material) {
    maker.quad({-2, -2, 0}, {4, 0, 0}, {0, 4, 0}, material);
    maker.sphere({0, 1, 2}, 0.5, material);
    maker.sphere({2, 1, 2}, 0.5, maker.lamp(3));
    maker.background({0.1f, 0.2f, 0.3f}, {0.4f, 0.5f, 0.6f});
    return maker.build();
  };
  const auto a = finish(plain, gray_plain);
  const auto b = finish(textured, MaterialId{0});
  for (std::uint64_t sample = 0; sample < 300; ++sample) {
    ASSERT_EQ(trace(*a, kAhead, sample, {}), trace(*b, kAhead, sample, {}));
  }
  test::report_hard_case("TX8", "radiance equal to the bit");
}

TEST(Path, CountsItsRays) {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  const auto scene = maker.build();
  PathCounts counts{.rays = 41};
  path_radiance(*scene, kAhead, PixelSampler(1, 2, 3), 0, {}, counts);
  EXPECT_EQ(counts.rays, 42u);
}

// In a closed sphere every path is truncated, and counted once. Under an open sky no path is
// truncated.
TEST(Path, CountsTruncatedPaths) {
  SceneMaker closed;
  closed.sphere({0, 0, 0}, 10, closed.diffuse(0.5f));
  SceneMaker misty = closed;
  test::fog(misty, test::medium(0.1f, 0.1f));
  SceneMaker open;
  open.background(gray(1), gray(1));
  open.sphere({0, 0, 0}, 1, open.diffuse(0.5f));
  const auto truncated = [](const SceneMaker& maker) {
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < 64; ++sample) {
      path_radiance(*maker.build(), kAhead, PixelSampler(1, 2, 3), sample,
                    {.max_depth = 2, .russian_roulette = false}, counts);
    }
    return counts.truncated;
  };
  EXPECT_EQ(truncated(closed), 64u);
  EXPECT_EQ(truncated(misty), 64u);
  EXPECT_EQ(truncated(open), 0u);
}

}  // namespace
}  // namespace bandsaw
