// Compares media with closed forms, within 4 standard errors. The boundaries of the media are
// instanced and move while the shutter is open. An id such as V6 in a test's name is that of a case
// in tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>

#include "tests/statistical/estimate.h"
#include "tests/support/media.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Returns a scene of a ball of radius 1, filled with the medium, under a white sky. The ball is
/// mirrored. Its placement changes from `from` to `to` while the shutter is open, from time 0 to 1.
SceneMaker moving_ball(const Medium& medium, const Transform& from, const Transform& to) {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  std::get<PerspectiveCamera>(maker.scene.camera).shutter = {0, 1};
  const MediumId inside = test::add(maker, medium);
  Geometry& boundaries = maker.scene.media.boundaries;
  boundaries.groups.push_back(unit_ball());
  boundaries.frames = {{kNoFrame, {}, {Key(0, from), Key(1, to)}}};
  Instance ball;
  ball.group = GroupId{0};
  ball.material = filled_with(inside);
  ball.frame = FrameId{0};
  ball.to_world = scaling({1, -1, 1});
  boundaries.instances.push_back(ball);
  return maker;
}

/// Returns the radiance along the ray, averaged over the time in which the shutter is open.
Moments seen_along(const Scene& scene, Ray ray, std::uint64_t samples) {
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 11, 7);
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      ray.time = sampler.group(sample, kGroupTime)[0];
      sum += path_radiance(scene, ray, sampler, sample, {.max_depth = 1000}, counts).g;
    }
    means.add(sum / static_cast<double>(samples));
  }
  return means;
}

/// Expects that the mean is `expected` within 4 standard errors. The standard error may be at most
/// 1e-3 of `expected`.
void expect_mean(const Moments& seen, double expected) {
  EXPECT_NEAR(seen.mean(), expected, 4 * seen.standard_error() + 2e-6 * expected);
  EXPECT_LE(seen.standard_error(), 1e-3 * expected);
}

// A ball grows from radius 0.5 to 1.5. The expected value is the mean of exp(-2 s r) over r.
TEST(MovingMedia, V6GrowingBallAbsorbsByTheMeanOverTheShutter) {
  const double s = 0.8;
  const Medium smoke = test::medium(0.8f, 0);
  const auto scene = moving_ball(smoke, scaling({0.5, 0.5, 0.5}), scaling({1.5, 1.5, 1.5})).build();
  expect_mean(seen_along(*scene, {.origin = {-9, 0, 0}, .direction = {1, 0, 0}}, 1024),
              (std::exp(-s) - std::exp(-3 * s)) / (2 * s));
}

// A ball moves through the ray, and the y of its centre goes from -2 to 2. While |y| < 1, the ball
// transmits exp(-2 s sqrt(1 - y^2)). At other times the ray misses the ball. The expected value is
// the mean over y. The integral over |y| < 1 is computed by Simpson's rule in the angle a, where
// y = cos(a).
TEST(MovingMedia, V6MovingBallAbsorbsByTheMeanOverTheShutter) {
  const double s = 0.8;
  const auto scene =
      moving_ball(test::medium(0.8f, 0), translation({0, -2, 0}), translation({0, 2, 0})).build();
  constexpr int kSteps = 1000;
  double sum = 0;
  for (int i = 0; i < kSteps; ++i) {
    const auto at = [&](double angle) {
      return std::exp(-2 * s * std::sin(angle)) * std::sin(angle);
    };
    const double h = kPi / kSteps;
    sum += h / 6 * (at(i * h) + 4 * at((i + 0.5) * h) + at((i + 1) * h));
  }
  expect_mean(seen_along(*scene, {.origin = {-9, 0, 0}, .direction = {1, 0, 0}}, 4096),
              (sum + 2) / 4);
}

TEST(MovingMedia, O8WithoutLossAreInvisibleInAWhiteSky) {
  const auto scene =
      moving_ball(test::medium(0, 2, 0.5), scaling({2, 1, -1}),
                  translation({1, 0.5, 0}) * rotation({1, 1, 0}, 70) * scaling({1, 3, -2}))
          .build();
  const Moments seen = seen_along(*scene, {.origin = {-9, 0.1, 0.2}, .direction = {1, 0, 0}}, 256);
  EXPECT_NEAR(seen.mean(), 1, 1e-5);
  EXPECT_LE(seen.standard_error(), 1e-5);
}

}  // namespace
}  // namespace bandsaw
