// Tests camera rays: their directions, depth of field, and times within the shutter interval. Also
// tests the errors for cameras with values that are out of range. An id such as C1 in a test's name
// is that of a case in tests/hard_cases/cases.txt.

#include "renderlib/camera/camera.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/hard_case.h"

namespace bandsaw {
namespace {

using ::testing::StartsWith;

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_NEAR(a.x, b.x, tolerance);
  EXPECT_NEAR(a.y, b.y, tolerance);
  EXPECT_NEAR(a.z, b.z, tolerance);
}

PerspectiveCamera camera(double fov) {
  PerspectiveCamera camera;
  camera.vertical_fov = fov;
  return camera;
}

TEST(Camera, TheMiddleRayIsStraightAndTopAndBottomRaysAreAtHalfTheAngle) {
  const RayGenerator rays(camera(90), 200, 100);
  expect_near(rays.ray(100, 50, 0, 0).direction, {0, 0, -1}, 1e-15);
  const double s = std::sqrt(0.5);
  expect_near(rays.ray(100, 0, 0, 0).direction, {0, s, -s}, 1e-15);
  expect_near(rays.ray(100, 100, 0, 0).direction, {0, -s, -s}, 1e-15);
  expect_near(rays.ray(200, 50, 0, 0).direction, Vec3{2, 0, -1} / std::sqrt(5.0), 1e-15);
  expect_near(rays.ray(0, 50, 0, 0).direction, Vec3{-2, 0, -1} / std::sqrt(5.0), 1e-15);
}

TEST(Camera, C1_DirectionsAreTheSameFarFromTheOrigin) {
  PerspectiveCamera near = camera(60);
  near.look_at = {0.1, -0.2, -1};
  PerspectiveCamera far = near;
  const Vec3 away{1e6, -1e6, 1e6};
  far.position = far.position + away;
  far.look_at = far.look_at + away;
  const RayGenerator a(near, 1920, 1080);
  const RayGenerator b(far, 1920, 1080);
  const double pixel = 1.0 / 1080;
  for (const double x : {0.5, 300.25, 1919.5}) {
    expect_near(a.ray(x, 777, 0, 0).direction, b.ray(x, 777, 0, 0).direction, 1e-6 * pixel);
  }
  test::report_hard_case("C1", "camera 1e6 away: directions of rays within 1e-6 pixel");
}

TEST(Camera, C3_ExtremeAnglesGiveFiniteUnitDirections) {
  for (const double fov : {1e-6, 179.9}) {
    const RayGenerator rays(camera(fov), 3, 3);
    const Vec3 d = rays.ray(0, 0, 0, 0).direction;
    EXPECT_NEAR(length(d), 1, 1e-15);
  }
  test::report_hard_case("C3",
                         "directions have length 1 for fields of view of 1e-6 and 179.9 degrees");
}

TEST(Camera, C2C3_CamerasThatCannotMakeRaysAreRefusedWithTheNameOfTheField) {
  const auto message = [](auto change) {
    PerspectiveCamera c = camera(40);
    change(c);
    return std::string(validate(Camera(c)).message());
  };
  EXPECT_EQ(message([](auto&) {}), "");
  EXPECT_THAT(message([](auto& c) { c.look_at = c.position; }), StartsWith("camera.look_at: "));
  EXPECT_THAT(message([](auto& c) { c.up = {0, 0, 3}; }), StartsWith("camera.up: "));
  EXPECT_THAT(message([](auto& c) { c.up = {0, 0, 0}; }), StartsWith("camera.up: "));
  EXPECT_THAT(message([](auto& c) { c.position.x = std::nan(""); }),
              StartsWith("camera.position: "));
  EXPECT_EQ(message([](auto& c) { c.vertical_fov = 180; }),
            "camera.vertical_fov: must be in (0, 180) degrees, is 180");
  EXPECT_EQ(message([](auto& c) { c.vertical_fov = 0; }),
            "camera.vertical_fov: must be in (0, 180) degrees, is 0");
  test::report_hard_case("C2", "refused with an error that names the field");
  test::report_hard_case("C3", "fields of view of 0 and 180 degrees are refused");
}

TEST(Camera, OrthographicRaysStartAtExactPixelPositions) {
  const OrthographicCamera upright{
      .position = {250, 250, 0}, .look_at = {250, 250, -1}, .height = 500};
  const RayGenerator upright_rays(upright, 500, 500);
  OrthographicCamera mirrored = upright;
  mirrored.up = {0, -1, 0};
  mirrored.mirrored = true;
  const RayGenerator mirrored_rays(mirrored, 500, 500);
  for (const double x : {0.0, 0.5, 17.25, 249.5, 499.5}) {
    for (const double y : {0.0, 3.5, 250.0, 499.75}) {
      EXPECT_EQ(upright_rays.ray(x, y, 0.3, 0.9).origin, (Vec3{x, 500 - y, 0}));
      EXPECT_EQ(upright_rays.ray(x, y, 0.3, 0.9).direction, (Vec3{0, 0, -1}));
      EXPECT_EQ(mirrored_rays.ray(x, y, 0.3, 0.9).origin, (Vec3{x, y, 0}));
      EXPECT_EQ(mirrored_rays.ray(x, y, 0.3, 0.9).direction, (Vec3{0, 0, -1}));
    }
  }
}

TEST(Camera, AllRaysOfAPixelMeetOnThePlaneOfFocus) {
  PerspectiveCamera lens = camera(50);
  lens.position = {1, 2, 3};
  lens.look_at = {4, 1, -6};
  lens.aperture = 0.5;
  lens.focus_distance = 7;
  PerspectiveCamera pinhole = lens;
  pinhole.aperture = 0;
  const RayGenerator rays(lens, 80, 60);
  const Vec3 forward = normalize(lens.look_at - lens.position);
  const Ray middle = RayGenerator(pinhole, 80, 60).ray(70.5, 11, 0, 0);
  const Vec3 focus = middle.origin + middle.direction * (7 / dot(middle.direction, forward));
  for (const double u : {0.0, 0.1, 0.77, 0.999}) {
    for (const double v : {0.0, 0.4, 0.9}) {
      const Ray ray = rays.ray(70.5, 11, u, v);
      EXPECT_LE(length(ray.origin - lens.position), 0.25 * (1 + 1e-12));
      EXPECT_NEAR(dot(ray.origin - lens.position, forward), 0, 1e-14);
      EXPECT_NEAR(length(ray.direction), 1, 1e-15);
      const double t = dot(focus - ray.origin, forward) / dot(ray.direction, forward);
      expect_near(ray.origin + ray.direction * t, focus, 1e-13);
    }
  }
}

TEST(Camera, C4_APointOutOfFocusSpreadsOverADiskOfTheRightRadius) {
  PerspectiveCamera lens = camera(40);
  lens.aperture = 0.3;
  lens.focus_distance = 5;
  for (const double z : {1.0, 2.5, 4.9, 8.0, 100.0}) {
    // Draws a line from each of many points on the lens through the point (0, 0, -z). The image
    // lies on the plane of focus, so the line meets the image at a position (x, y). The camera's
    // ray from the same point on the lens to (x, y) must pass through (0, 0, -z).
    const RayGenerator rays(lens, 1000, 1000);
    const double pixel = 2 * std::tan(20 * 3.14159265358979 / 180) / 1000;
    double largest = 0;
    double squares = 0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      for (int j = 0; j < kSteps; ++j) {
        const double u = (i + 0.5) / kSteps;
        const double v = (j + 0.5) / kSteps;
        const Vec3 on_lens = rays.ray(500, 500, u, v).origin;
        const double scale = (z - 5) / z;
        const double x = 500 + on_lens.x * scale / 5 / pixel;
        const double y = 500 - on_lens.y * scale / 5 / pixel;
        const Ray ray = rays.ray(x, y, u, v);
        expect_near(ray.origin + ray.direction * (z / -ray.direction.z), {0, 0, -z}, 1e-11 * z);
        const double r = std::hypot(x - 500, y - 500) * pixel * 5;
        largest = std::max(largest, r);
        squares += r * r / (kSteps * kSteps);
      }
    }
    // The lens has the radius 0.15, and the plane of focus is at 5. The disk on this plane and the
    // lens are the bases of two similar cones with their tip at (0, 0, -z).
    const double expected = 0.15 * std::abs(z - 5) / z;
    EXPECT_NEAR(largest, expected, 0.01 * expected) << z;
    // For a uniform distribution on a disk, the mean square distance from the centre is half the
    // squared radius.
    EXPECT_NEAR(std::sqrt(2 * squares), expected, 0.01 * expected) << z;
  }
  test::report_hard_case("C4", "blur radius within 1 % for points at five distances");
}

TEST(Camera, C4_FocusAtAnyDistanceGivesFiniteUnitDirections) {
  PerspectiveCamera lens = camera(40);
  for (const double aperture : {1e-300, 1.0, 1e30}) {
    for (const double focus : {kMinFocus, 1e-6, 1e30}) {
      lens.aperture = aperture;
      lens.focus_distance = focus;
      const Ray ray = RayGenerator(lens, 8, 8).ray(1, 2, 0.9, 0.1);
      EXPECT_NEAR(length(ray.direction), 1, 1e-15) << aperture << ' ' << focus;
      EXPECT_TRUE(is_finite(ray.origin));
    }
  }
  lens.aperture = 0;
  const Ray sharp = RayGenerator(lens, 8, 8).ray(1, 2, 0.9, 0.1);
  EXPECT_EQ(sharp.origin, (Vec3{0, 0, 0}));
  test::report_hard_case("C4", "rays are finite for focus distances 1e-6 and 1e30");
}

TEST(Camera, LensAndHeightOutOfRangeAreRefused) {
  PerspectiveCamera lens = camera(40);
  lens.aperture = -1;
  EXPECT_THAT(std::string(validate(Camera(lens)).message()), StartsWith("camera.aperture: "));
  lens.aperture = 1;
  lens.focus_distance = 0;
  EXPECT_THAT(std::string(validate(Camera(lens)).message()), StartsWith("camera.focus_distance: "));
  EXPECT_THAT(std::string(validate(Camera(OrthographicCamera{.height = 0})).message()),
              StartsWith("camera.orthographic.height: "));
  EXPECT_THAT(std::string(validate(Camera(OrthographicCamera{.up = {0, 0, 1}})).message()),
              StartsWith("camera.up: "));
}

TEST(Camera, C8_RaysHaveTimesFromOpeningToClosing) {
  PerspectiveCamera c = camera(40);
  EXPECT_EQ(RayGenerator(c, 8, 8).ray(1, 2, 0, 0, 0.7).time, 0);
  c.shutter = {0.1, 0.7};
  const RayGenerator rays(c, 8, 8);
  EXPECT_EQ(rays.ray(1, 2, 0, 0, 0).time, 0.1);
  EXPECT_EQ(rays.ray(1, 2, 0, 0, 1).time, 0.7);
  EXPECT_LE(rays.ray(1, 2, 0, 0, 1 - 0x1p-32).time, 0.7);
  EXPECT_NEAR(rays.ray(1, 2, 0, 0, 0.5).time, 0.4, 1e-15);
  EXPECT_EQ(rays.ray(1, 2, 0, 0, 0.5).direction, rays.ray(1, 2, 0, 0, 0.1).direction);
  c.shutter = {3, 3};
  EXPECT_EQ(RayGenerator(c, 8, 8).ray(1, 2, 0, 0, 0.7).time, 3);
  c.shutter = {3, 2};
  EXPECT_EQ(std::string(validate(Camera(c)).message()),
            "camera.shutter_close: must not be before 3, the value of shutter_open; it is 2");
  c.shutter = {std::nan(""), 2};
  EXPECT_THAT(std::string(validate(Camera(c)).message()), StartsWith("camera.shutter_open"));
  test::report_hard_case(
      "C8", "ray times are within the shutter interval; a reversed interval is refused");
}

}  // namespace
}  // namespace bandsaw
