// With path reuse (renderlib/integrate/path_reuse.h), pixels share vertices of their paths. Tests
// that the means are the same as without path reuse, within 4 standard errors, and that the
// variance is lower, also behind mirrors and glass. The scene is a Cornell box in which the pixels
// see different surfaces. Some pixels do not see all parts of the box. integrating_sphere_test.cpp
// compares path reuse with a closed form.

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/statistical/path_reuse_estimate.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

constexpr std::uint64_t kSamples = 1024;

/// Returns rays from the camera through points in front of the back wall, at z = 400. The points
/// have x from `from` to `to`, and y = `height`.
std::array<Ray, kMaxReusePixels> rays_across(double from, double to, double height) {
  std::array<Ray, kMaxReusePixels> rays;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Vec3 origin = {278, 278, -800};
    const double x = from + (to - from) * static_cast<double>(i) / (kMaxReusePixels - 1);
    rays[i] = {.origin = origin, .direction = normalize(Vec3{x, height, 400} - origin)};
  }
  return rays;
}

/// Expects that the means with and without path reuse differ by at most 4 standard errors.
/// `precision`: the largest accepted standard error of this difference, relative to the mean.
void expect_equal_means(const Scene& scene, const std::array<Ray, kMaxReusePixels>& rays,
                        const PathOptions& options, double precision) {
  const auto shared = test::radiance_with_reuse_along(scene, rays, options, kSamples);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    SCOPED_TRACE(i);
    const test::Moments alone = test::radiance_along(scene, rays[i], options, kSamples);
    const double error = std::hypot(alone.standard_error(), shared[i].standard_error());
    EXPECT_LE(std::abs(alone.mean() - shared[i].mean()), 4 * error)
        << alone.mean() << " +- " << alone.standard_error() << ", shared " << shared[i].mean()
        << " +- " << shared[i].standard_error();
    EXPECT_LE(error, precision * alone.mean());
  }
}

TEST(PathReuse, MeansEqualPathTracingAcrossACornerAndABox) {
  const auto box = test::cornell_box().build();
  ASSERT_TRUE(box->reuses_paths());
  expect_equal_means(*box, rays_across(40, 440, 150), {.max_depth = 4}, 0.01);
}

TEST(PathReuse, MeansEqualPathTracingBehindFuzzyMetalAndGlass) {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({120, 240, 200}, 60, maker.glass(1.5));
  maker.sphere({400, 240, 260}, 60, maker.metal(0.9f, 0.4));
  const auto box = maker.build();
  ASSERT_TRUE(box->reuses_paths());
  expect_equal_means(*box, rays_across(60, 440, 240), {.max_depth = 4}, 0.03);
}

// The path of a pixel that shows a black surface ends on this surface, so the pixel shares no
// vertex. The balance heuristic of the other pixels must not count the pdf of this pixel. If it
// did, the other pixels would lose light.
TEST(PathReuse, MeansEqualPathTracingBesideABlackSurface) {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({150, 240, 200}, 90, maker.diffuse(0.0f));
  const auto box = maker.build();
  ASSERT_TRUE(box->reuses_paths());
  expect_equal_means(*box, rays_across(60, 440, 240), {.max_depth = 4}, 0.03);
}

// Pixels that show the mirror have one scattering less left than pixels that show the wall, so with
// a small `max_depth` they must not share vertices.
TEST(PathReuse, MeansEqualPathTracingInAMirrorAndBesideIt) {
  test::SceneMaker maker = test::cornell_box();
  maker.sphere({150, 240, 200}, 90, maker.metal(0.9f, 0));
  const auto box = maker.build();
  ASSERT_TRUE(box->reuses_paths());
  for (const std::uint32_t max_depth : {2, 3, 8}) {
    SCOPED_TRACE(max_depth);
    expect_equal_means(*box, rays_across(60, 440, 240), {.max_depth = max_depth}, 0.03);
  }
}

/// Returns the sum over the pixels of the variances of their means, without path reuse divided by
/// that with path reuse.
double gain_of_reuse(const Scene& scene, const std::array<Ray, kMaxReusePixels>& rays) {
  const PathOptions options{.max_depth = 8};
  const auto shared = test::radiance_with_reuse_along(scene, rays, options, 64, 64);
  double with = 0;
  double without = 0;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    with += shared[i].variance();
    without += test::radiance_along(scene, rays[i], options, 64, 64).variance();
  }
  return without / with;
}

// Each variance is measured with 64 seeds. The gains are about 5 on the wall, 10 for the ceiling in
// the mirror, and 3 in the glass ball. If pixels behind mirrors and glass shared nothing, the
// quotient of the sums, with 504 degrees of freedom each, would be above 1.5 with a probability of
// 3e-6.
TEST(PathReuse, LowersTheVarianceInAMirrorAndBehindGlass) {
  const auto wall = test::cornell_box().build();
  test::SceneMaker with_mirror = test::cornell_box();
  with_mirror.quad({178, 140, 20}, {200, 0, 0}, {0, 200, 200}, with_mirror.metal(0.9f, 0));
  test::SceneMaker with_glass = test::cornell_box();
  with_glass.sphere({278, 240, 200}, 150, with_glass.glass(1.5));
  const std::array<Ray, kMaxReusePixels> rays = rays_across(250, 306, 240);
  const double on_wall = gain_of_reuse(*wall, rays);
  const double in_mirror = gain_of_reuse(*with_mirror.build(), rays);
  const double in_glass = gain_of_reuse(*with_glass.build(), rays);
  EXPECT_GT(on_wall, 1.5);
  EXPECT_GT(in_mirror, 1.5);
  EXPECT_GT(in_glass, 1.5);
}

}  // namespace
}  // namespace bandsaw
