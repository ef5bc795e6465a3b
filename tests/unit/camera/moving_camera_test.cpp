// Cameras that move while the shutter is open.

#include <gtest/gtest.h>

#include "renderlib/camera/camera.h"

namespace bandsaw {
namespace {

constexpr Shutter kShutter{2, 4};

/// Returns a camera at (x, 0, 5) that looks along -z.
PerspectiveCamera at(double x) {
  return {.position = {x, 0, 5}, .look_at = {x, 0, 0}, .shutter = kShutter};
}

void expect_close(const Vec3& a, const Vec3& b) {
  EXPECT_NEAR(a.x, b.x, 1e-12);
  EXPECT_NEAR(a.y, b.y, 1e-12);
  EXPECT_NEAR(a.z, b.z, 1e-12);
}

TEST(MovingCamera, RaysStartWhereTheCameraIsAtTheirTime) {
  const RayGenerator rays(at(0), 20, 10, Camera(at(8)));
  for (const double share : {0.0, 0.25, 1.0}) {
    const Ray ray = rays.ray(10, 5, 0, 0, share);
    EXPECT_DOUBLE_EQ(ray.time, 2 + 2 * share);
    expect_close(ray.origin, {8 * share, 0, 5});
    expect_close(ray.direction, {0, 0, -1});
  }
}

TEST(MovingCamera, EqualsTheStaticCamerasAtBothEnds) {
  PerspectiveCamera last = at(3);
  last.look_at = {1, 2, 0};
  last.vertical_fov = 60;
  last.aperture = 0.5;
  last.focus_distance = 7;
  PerspectiveCamera first = at(-1);
  first.aperture = 0.2;
  first.focus_distance = 4;
  const RayGenerator moving(first, 20, 10, Camera(last));
  const Ray opening = moving.ray(3.25, 8.5, 0.3, 0.8, 0);
  const Ray closing = moving.ray(3.25, 8.5, 0.3, 0.8, 1);
  expect_close(opening.origin, RayGenerator(first, 20, 10).ray(3.25, 8.5, 0.3, 0.8).origin);
  expect_close(opening.direction, RayGenerator(first, 20, 10).ray(3.25, 8.5, 0.3, 0.8).direction);
  expect_close(closing.origin, RayGenerator(last, 20, 10).ray(3.25, 8.5, 0.3, 0.8).origin);
  expect_close(closing.direction, RayGenerator(last, 20, 10).ray(3.25, 8.5, 0.3, 0.8).direction);
}

// A lens view describes all rays from the lens through one point in focus. For a ray in the middle
// of the shutter interval, the view must find the point of the lens at which the ray starts.
TEST(MovingCamera, TheLensViewAgreesWithTheRay) {
  PerspectiveCamera first = at(0);
  first.aperture = 0.4;
  first.focus_distance = 5;
  PerspectiveCamera last = first;
  last.position = {2, 1, 5};
  last.look_at = {2, 0, 0};
  const RayGenerator rays(first, 20, 10, Camera(last));
  const auto view = rays.lens_view(4, 3, 0.5);
  ASSERT_TRUE(view.has_value());
  for (const double u : {0.1, 0.6, 0.9}) {
    const Ray ray = rays.ray(4, 3, u, 0.7, 0.5);
    const auto on_lens = view->on_lens(ray.direction);
    ASSERT_TRUE(on_lens.has_value());
    expect_close(*on_lens, ray.origin);
  }
}

TEST(MovingCamera, ParallelRaysKeepUnitDirections) {
  const OrthographicCamera first{.position = {0, 0, 5}, .look_at = {0, 0, 0}, .shutter = kShutter};
  OrthographicCamera last = first;
  last.look_at = {5, 0, 0};
  const RayGenerator rays(first, 20, 10, Camera(last));
  EXPECT_NEAR(length(rays.ray(1, 2, 0, 0, 0.5).direction), 1, 1e-12);
}

TEST(MovingCamera, MotionsBetweenIncompatibleCamerasAreRefused) {
  EXPECT_TRUE(validate_motion(at(0), at(1)).ok());
  EXPECT_FALSE(validate_motion(at(0), OrthographicCamera{.shutter = kShutter}).ok());
  PerspectiveCamera lens = at(1);
  lens.aperture = 1;
  EXPECT_FALSE(validate_motion(at(0), lens).ok()) << "a pinhole must not become a lens";
  PerspectiveCamera later = at(1);
  later.shutter = {3, 4};
  EXPECT_FALSE(validate_motion(at(0), later).ok());
  PerspectiveCamera broken = at(1);
  broken.vertical_fov = 180;
  EXPECT_FALSE(validate_motion(at(0), broken).ok());
}

}  // namespace
}  // namespace bandsaw
