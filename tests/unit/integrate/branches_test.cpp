// Path splitting: at the first surface whose BSDF has a pdf, a path continues in several directions
// (branches).

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/integrate/path.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

const Ray kDown{.origin = {0.1, 3, 0.2}, .direction = {0, -1, 0}};

/// A floor and a wall under a non-uniform sky. With `behind_glass`, the floor and the wall are seen
/// through a ball of glass.
SceneMaker corner(bool behind_glass) {
  SceneMaker maker;
  const MaterialId gray = maker.diffuse({0.7f, 0.5f, 0.6f});
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, gray);
  maker.quad({-0.3, 0, -5}, {0, 0, 10}, {0, 2, 0}, gray);
  maker.background({0.2f, 0.3f, 0.4f}, {0.9f, 0.8f, 0.7f});
  if (behind_glass) {
    maker.sphere({0.1, 2, 0.2}, 0.3, maker.glass(1.5));
  }
  return maker;
}

/// Returns the radiance of one sample along kDown. Adds the rays to `counts`.
Rgb sample_of(const Scene& scene, std::uint64_t sample, std::uint32_t branches,
              PathCounts& counts) {
  return path_radiance(scene, kDown, PixelSampler(1, 2, 3), sample, {.branches = branches}, counts);
}

// Branch i of sample s has the radiance that sample s * branches + i has without path splitting.
TEST(Branches, EachHasTheRadianceOfAnUnsplitPath) {
  const auto scene = corner(false).build();
  PathCounts whole;
  PathCounts parts;
  for (std::uint64_t sample = 0; sample < 100; ++sample) {
    for (const std::uint32_t branches : {2u, 4u}) {
      Rgb sum;
      for (std::uint32_t i = 0; i < branches; ++i) {
        sum += sample_of(*scene, sample * branches + i, 1, parts);
      }
      ASSERT_EQ(sample_of(*scene, sample, branches, whole),
                sum * (1 / static_cast<float>(branches)));
    }
  }
  // All branches of a sample share the ray from the camera. So two branches save one ray, and four
  // branches save three.
  EXPECT_EQ(whole.rays, parts.rays - 100 * (1 + 3));
}

/// Returns the moments of the radiance over many pixels, with one sample in each. The pixels are
/// independent.
test::Moments moments_of(const Scene& scene, std::uint64_t sample, std::uint32_t branches) {
  test::Moments moments;
  PathCounts counts;
  for (std::uint32_t i = 0; i < 20'000; ++i) {
    const PixelSampler sampler(5, i, 0);
    moments.add(path_radiance(scene, kDown, sampler, sample, {.branches = branches}, counts).g);
  }
  return moments;
}

TEST(Branches, HaveTheMeanOfUnsplitPaths) {
  for (const bool behind_glass : {false, true}) {
    const auto scene = corner(behind_glass).build();
    // The branches of sample 7 equal the unsplit samples 28 to 31, which differ from sample 0.
    const test::Moments one = moments_of(*scene, /*sample=*/0, /*branches=*/1);
    const test::Moments four = moments_of(*scene, /*sample=*/7, /*branches=*/4);
    const double deviation = std::hypot(one.standard_error(), four.standard_error());
    EXPECT_LE(std::abs(one.mean() - four.mean()), 4 * deviation) << behind_glass;
    // Four stratified branches have less variance than four independent samples. Behind glass the
    // gain is smaller, because all branches share the choice of reflection at the glass.
    EXPECT_LT(four.variance(), (behind_glass ? 0.7 : 0.25) * one.variance());
  }
}

TEST(Branches, ATruncatedPathCountsOnce) {
  SceneMaker closed;
  closed.sphere({0, 0, 0}, 10, closed.diffuse(0.5f));
  PathCounts counts;
  path_radiance(*closed.build(), kDown, PixelSampler(1, 2, 3), 0, {.max_depth = 2, .branches = 4},
                counts);
  EXPECT_EQ(counts.truncated, 1u);
}

// Paths in a scene with lights are not split. In other scenes they have two branches, or four if
// there are meshes, which can occlude the sky at their own surface (integrate/README.md).
TEST(Branches, AreUsedOnlyInScenesWithoutLights) {
  SceneMaker shapes = corner(false);
  EXPECT_EQ(branches_for(*shapes.build()), 2u);
  SceneMaker lit = shapes;
  lit.sphere({0, 9, 0}, 1, lit.lamp(3));
  EXPECT_EQ(branches_for(*lit.build()), 1u);
  SceneMaker with_mesh = shapes;
  with_mesh.instance(test::grid(2), {}, MaterialId{0});
  EXPECT_EQ(branches_for(*with_mesh.build()), 4u);
}

}  // namespace
}  // namespace bandsaw
