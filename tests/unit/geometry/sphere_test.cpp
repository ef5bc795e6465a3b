#include <gtest/gtest.h>

#include <optional>

#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/sphere_uv.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/math/constants.h"
#include "tests/support/meshes.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::Wide;
using test::wide_sqrt;
using test::WideVec;

constexpr double kUnit = 0x1p-53;

std::optional<double> hit(const Ray& ray, const Sphere& sphere, bool starts_on_it = false) {
  Crossing crossing;
  if (!intersect(trace_setup(ray.origin, ray.direction, ray.t_max), sphere, starts_on_it,
                 crossing)) {
    return std::nullopt;
  }
  return crossing.t;
}

/// The impact parameter squared and the near root, without rounding.
struct Truth {
  Wide offset2;
  Wide near;
};

Truth truth(const Ray& ray, const Sphere& sphere) {
  const WideVec f = WideVec(ray.origin) - sphere.center;
  const WideVec d = ray.direction;
  const Wide a = dot(d, d);
  const Wide b = -dot(f, d);
  const WideVec closest = f + d * (b / a);
  const Wide offset2 = dot(closest, closest);
  const Wide r = sphere.radius;
  return {offset2, (b - wide_sqrt(a * (r * r - offset2))) / a};
}

TEST(Sphere, IsHitRightFromFarAway) {
  test::Random random(1);
  for (const double distance : {150.0, 1.5e3, 1.5e4, 1.5e6}) {
    double square_error = 0;
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
      const Vec3 center = 0.5 * test::random_point(random) + Vec3{0.5, 0.5, 0.5};
      const Sphere sphere = {center, 1, {}};
      const Vec3 origin = center + distance * test::random_direction(random);
      const Vec3 target =
          center + 1.05 * test::random_direction(random) * std::cbrt(random.uniform());
      const Ray ray = {origin, normalize(target - origin)};
      const Truth t = truth(ray, sphere);
      const auto found = hit(ray, sphere);
      const double margin = std::abs(static_cast<double>(wide_sqrt(t.offset2)) - 1);
      if (margin > 16 * kUnit * (1 + distance)) {
        ASSERT_EQ(found.has_value(), t.offset2 < 1) << distance;
      }
      if (found && margin > 1e-3) {
        const double error = static_cast<double>(*found - t.near);
        square_error += error * error;
        ++hits;
      }
    }
    ASSERT_GT(hits, 10000);
    const double rms = std::sqrt(square_error / hits);
    EXPECT_LE(rms, distance <= 1500 ? 1e-10 : 1e-7) << distance;
  }
}

TEST(Sphere, TangentRaysAreDecidedRightAndNeverNan) {
  test::Random random(2);
  for (int k = 3; k <= 15; ++k) {
    for (const double side : {-1.0, 1.0}) {
      for (int i = 0; i < 500; ++i) {
        const double b = 1 + side * std::pow(10, -k);
        const Sphere sphere = {{0.3, -0.2, 0.1}, 1, {}};
        const Vec3 d = test::random_direction(random);
        const Vec3 across = normalize(cross(d, test::random_direction(random)));
        const Ray ray = {sphere.center + b * across - 2 * d, d};
        const Wide offset2 = truth(ray, sphere).offset2;
        const double margin = std::abs(static_cast<double>(wide_sqrt(offset2) - 1));
        const auto found = hit(ray, sphere);
        if (margin > 16 * kUnit * 3) {
          ASSERT_EQ(found.has_value(), offset2 < 1) << k;
        }
        if (found) {
          ASSERT_NEAR(*found, 2, 0.2);
        }
      }
    }
  }
}

TEST(Sphere, HitPointsLieOnItHoweverLarge) {
  test::Random random(3);
  for (const double radius : {1e3, 1e5, 1e7}) {
    Geometry g;
    g.spheres.push_back({{0, -radius, 0}, radius, {}});
    for (int i = 0; i < 20000; ++i) {
      const Vec3 origin = {0, 1, 0};
      const Vec3 target = {random.uniform(-20, 20), 0, random.uniform(-20, 20)};
      const Ray ray = {origin, target - origin};
      const auto t = hit(ray, g.spheres[0]);
      if (!t) {
        continue;
      }
      const SurfacePoint p = surface_at(g, ray, {*t, {0, 0}, 0, 0});
      const Wide height = length(WideVec(p.position) - g.spheres[0].center) - radius;
      ASSERT_LE(std::abs(static_cast<double>(height)), 4 * kUnit * (radius + 1));
      const Vec3 up = test::random_direction(random);
      const Vec3 out = dot(up, p.geometric_normal) < 0 ? -up : up;
      const Ray away = leave(p, out);
      ASSERT_FALSE(hit(away, g.spheres[0], true));
      ASSERT_FALSE(hit(away, g.spheres[0], false)) << "the offset alone is enough";
    }
  }
}

TEST(Sphere, IsLeftOnTheFarSideFromWithin) {
  test::Random random(4);
  const Sphere sphere = {{1, 2, 3}, 2, {}};
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = test::random_direction(random);
    const Vec3 d = test::random_direction(random);
    const double cosine = -dot(n, d);
    if (cosine < 1e-3) {
      continue;
    }
    const auto t = hit({sphere.center + 2 * n, d}, sphere, true);
    ASSERT_TRUE(t);
    // The start is rounded, which moves the exit of a flat chord most.
    ASSERT_NEAR(*t / (4 * cosine), 1, 1e-14 / (cosine * cosine));
  }
  EXPECT_EQ(hit({sphere.center, {0, 1, 0}}, sphere), 2);
}

TEST(Sphere, TakesTheFirstRootAhead) {
  const Sphere sphere = {{0, 0, 0}, 1, {}};
  EXPECT_EQ(hit({{0, 0, -3}, {0, 0, 1}}, sphere), 2);
  EXPECT_EQ(hit({{0, 0, 0.5}, {0, 0, 1}}, sphere), 0.5);
  EXPECT_FALSE(hit({{0, 0, 3}, {0, 0, 1}}, sphere));
  EXPECT_FALSE(hit({{0, 0, -3}, {0, 0, 1}, 2}, sphere));
  EXPECT_EQ(hit({{0, 0, -3}, {0, 0, 1}}, sphere, true), 4);
}

TEST(Sphere, DoesNotCareForTheLengthOfTheDirection) {
  test::Random random(5);
  const Sphere sphere = {{0.1, 0.2, 0.3}, 1, {}};
  for (int i = 0; i < 1000; ++i) {
    const Vec3 origin = 3 * test::random_direction(random);
    const Vec3 d = test::random_point(random) - origin;
    const auto t = hit({origin, d}, sphere);
    const auto small = hit({origin, d * 0x1p-40}, sphere);
    const auto large = hit({origin, d * 0x1p40}, sphere);
    ASSERT_EQ(t.has_value(), small.has_value());
    ASSERT_EQ(t.has_value(), large.has_value());
    if (t) {
      EXPECT_EQ(*small, *t * 0x1p40);
      EXPECT_EQ(*large, *t * 0x1p-40);
    }
  }
}

TEST(Sphere, TinyOnesAreSolid) {
  test::Random random(6);
  for (const double radius : {1e-4, 1e-6}) {
    Geometry g;
    g.spheres.push_back({{0.3, 0.4, 0.5}, radius, {}});
    for (int i = 0; i < 20000; ++i) {
      const Vec3 origin = g.spheres[0].center + test::random_direction(random);
      const Vec3 target = g.spheres[0].center + 0.99 * radius * test::random_direction(random);
      const Ray ray = {origin, normalize(target - origin)};
      const auto t = hit(ray, g.spheres[0]);
      ASSERT_TRUE(t);
      const SurfacePoint p = surface_at(g, ray, {*t, {0, 0}, 0, 0});
      ASSERT_TRUE(hit(leave(p, ray.direction), g.spheres[0], true));
    }
  }
}

TEST(SphereUv, IsAGlobe) {
  const auto expect_uv = [](const Vec3& n, double u, double v) {
    EXPECT_NEAR(sphere_uv(n).x, u, 1e-15);
    EXPECT_NEAR(sphere_uv(n).y, v, 1e-15);
  };
  expect_uv({1, 0, 0}, 0.5, 0.5);
  expect_uv({0, 0, -1}, 0.75, 0.5);
  expect_uv({0, 0, 1}, 0.25, 0.5);
  expect_uv({-1, 0, 0}, 0, 0.5);
  EXPECT_EQ(sphere_uv({0, 1, 0}).y, 1);
  EXPECT_EQ(sphere_uv({0, -1, 0}).y, 0);
}

TEST(SphereUv, StaysInTheUnitSquare) {
  test::Random random(7);
  for (int i = 0; i < 200000; ++i) {
    Vec3 n = test::random_direction(random);
    if (i % 3 == 0) {
      n = normalize(Vec3{-1, n.y, n.z * 1e-17});  // along the seam
    }
    if (i % 5 == 0) {
      n.y = std::copysign(1 + kUnit * 2, n.y);  // a pole, one rounding too far
    }
    const Vec2 uv = sphere_uv(n);
    ASSERT_TRUE(uv.x >= 0 && uv.x < 1 && uv.y >= 0 && uv.y <= 1) << uv.x << " " << uv.y;
  }
}

}  // namespace
}  // namespace bandsaw
