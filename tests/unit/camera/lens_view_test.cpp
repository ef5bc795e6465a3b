// Tests LensView, which describes all rays from the lens through one point in focus, and gives the
// pdf of their directions. The renderer uses LensView to sample lights that are out of focus.

#include "renderlib/camera/lens_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "renderlib/camera/camera.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/sampler.h"

namespace bandsaw {
namespace {

PerspectiveCamera lens() {
  PerspectiveCamera camera;
  camera.position = {3, 1, -2};
  camera.look_at = {2.5, 0.7, -9};
  camera.aperture = 0.8;
  camera.focus_distance = 4;
  return camera;
}

TEST(LensView, AllRaysThroughThePointInFocusAreInTheView) {
  const PerspectiveCamera camera = lens();
  const RayGenerator rays(camera, 60, 40);
  const double area = kPi * camera.aperture * camera.aperture / 4;
  const Vec3 forward = normalize(camera.look_at - camera.position);
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const Sample4 at = sample4({1, 2, 3, i}, 0);
    const auto view = rays.lens_view(60 * at[0], 40 * at[1]);
    ASSERT_TRUE(view);
    const Ray ray = rays.ray(60 * at[0], 40 * at[1], at[2], at[3]);
    const Vec3 direction = view->focus() - ray.origin;
    EXPECT_LE(length(cross(direction, ray.direction)), 1e-14 * length(direction));
    EXPECT_TRUE(view->beyond().contains(ray.direction));
    EXPECT_FALSE(view->beyond().contains(-ray.direction));
    const double cosine = dot(ray.direction, forward);
    EXPECT_NEAR(view->pdf(ray.direction), length_squared(direction) / (area * cosine),
                1e-12 * view->pdf(ray.direction));
    // The origin is moved a little towards the middle of the lens, because rounding decides whether
    // a ray at the very rim passes through the lens.
    const Vec3 inwards = normalize(view->focus() - (ray.origin * 0.999 + camera.position * 0.001));
    const std::optional<Vec3> from = view->on_lens(inwards);
    ASSERT_TRUE(from);
    EXPECT_LE(length(*from - (ray.origin * 0.999 + camera.position * 0.001)), 1e-13);
    // A point that is 1,000 times as far from the middle lies beside the lens in nearly all cases.
    const Vec3 beside = camera.position + (ray.origin - camera.position) * 1000;
    EXPECT_EQ(view->on_lens(normalize(view->focus() - beside)).has_value(),
              length(beside - camera.position) <= camera.aperture / 2);
  }
}

TEST(LensView, TheMeanOfTheInversePdfIsTheSolidAngle) {
  const PerspectiveCamera camera = lens();
  const RayGenerator rays(camera, 60, 40);
  const auto view = rays.lens_view(30, 20);
  double sum = 0;
  constexpr int kSamples = 4096;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const Sample4 at = sample4({1, 2, 3, i}, 0);
    sum += 1 / view->pdf(rays.ray(30, 20, at[2], at[3]).direction);
  }
  // The lens has the radius 0.4, and its middle is at the distance 4 from the point in focus.
  const double solid_angle = 2 * kPi * (1 - 4 / std::sqrt(4 * 4 + 0.4 * 0.4));
  EXPECT_NEAR(sum / kSamples, solid_angle, 1e-5 * solid_angle);
}

// A lens is too wide if its radius is at least the distance from its middle to the point in focus.
TEST(LensView, DoesNotExistForPinholesParallelRaysAndVeryWideLenses) {
  PerspectiveCamera camera = lens();
  camera.aperture = 0;
  EXPECT_FALSE(RayGenerator(camera, 60, 40).lens_view(30, 20));
  camera.aperture = 8;
  EXPECT_FALSE(RayGenerator(camera, 60, 40).lens_view(30, 20));
  EXPECT_FALSE(RayGenerator(OrthographicCamera{}, 60, 40).lens_view(30, 20));
  camera.aperture = kMaxLens;
  camera.focus_distance = kMinFocus;
  EXPECT_FALSE(RayGenerator(camera, 60, 40).lens_view(30, 20));
}

TEST(LensView, IsFiniteForAVeryDistantFocus) {
  PerspectiveCamera camera = lens();
  camera.focus_distance = kMaxLens;
  const auto view = RayGenerator(camera, 60, 40).lens_view(30, 20);
  ASSERT_TRUE(view);
  EXPECT_FALSE(view->beyond().contains(camera.position - view->focus()));
  EXPECT_TRUE(std::isfinite(view->pdf(normalize(camera.look_at - camera.position))));
}

}  // namespace
}  // namespace bandsaw
