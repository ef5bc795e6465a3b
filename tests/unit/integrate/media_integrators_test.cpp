// Tests media with the integrators other than `path`.

#include <gtest/gtest.h>

#include <cmath>

#include "renderlib/integrate/sample_value.h"
#include "tests/support/media.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

const Ray kAhead{.origin = {0, 0, 5}, .direction = {0, 0, -1}};

/// Returns the value of one sample of this pixel along kAhead.
Rgb value(const Scene& scene, Integrator integrator, std::uint32_t pixel = 1) {
  PathCounts counts;
  const PathOptions options{.local = integrator == Integrator::kDirect};
  return sample_value(scene, integrator, kAhead, PixelSampler(1, pixel, 2), 0, options, counts);
}

TEST(MediaIntegrators, ABoundaryWithoutASurfaceIsInvisible) {
  SceneMaker maker;
  maker.quad({-1, -1, 0}, {2, 0, 0}, {0, 2, 0}, maker.diffuse(0.25f));
  const auto without = maker.build();
  const MediumId smoke = test::add(maker, test::medium(1, 1));
  test::fill_sphere(maker, {0, 0, 3}, 1, smoke);
  test::fill_box(maker, {-2, -2, -2}, {2, 2, 1}, smoke);
  const auto with = maker.build();
  for (const Integrator integrator : {Integrator::kNormals, Integrator::kDepth, Integrator::kAlbedo,
                                      Integrator::kAmbientOcclusion}) {
    EXPECT_EQ(value(*with, integrator), value(*without, integrator));
  }
}

// The ray passes 2 units of a medium with the extinction 0.8, so the optical depth is 1.6. The
// medium stops the share 1 - exp(-1.6) of the light. The ambient term is this share times the
// albedo, 0.75, times the ambient radiance, 0.5.
TEST(MediaIntegrators, DirectAttenuatesAndAddsTheAmbientTerm) {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  maker.scene.local_shading.ambient = gray(0.5f);
  test::fill_sphere(maker, {0, 0, 0}, 1, test::add(maker, test::medium(0.2f, 0.6f)));
  const double passing = std::exp(-1.6);
  EXPECT_NEAR(value(*maker.build(), Integrator::kDirect).g, passing + 0.75 * (1 - passing) * 0.5,
              1e-6);
}

TEST(MediaIntegrators, DirectEqualsPathsOfOneScattering) {
  SceneMaker maker;
  maker.sphere({1, 0.5, 0}, 0.2, maker.lamp(10));
  test::fog(maker, test::medium(0.1f, 0.3f, 0.4));
  const auto scene = maker.build();
  Moments direct;
  Moments once;
  for (std::uint32_t pixel = 0; pixel < 20000; ++pixel) {
    PathCounts counts;
    direct.add(value(*scene, Integrator::kDirect, pixel).g);
    once.add(
        path_radiance(*scene, kAhead, PixelSampler(2, pixel, 2), 0, {.max_depth = 1}, counts).g);
  }
  EXPECT_GT(direct.mean(), 0.005);
  EXPECT_LE(std::abs(direct.mean() - once.mean()),
            4 * std::hypot(direct.standard_error(), once.standard_error()));
}

}  // namespace
}  // namespace bandsaw
