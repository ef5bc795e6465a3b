// Tests the hard cases S1 to S8 and S10 (spheres) and M9 (a bubble in glass), which cases.txt
// lists.
//
// In texts, u is the unit roundoff of double, 2^-53.

#include <gtest/gtest.h>

#include <optional>
#include <string>

#include "renderlib/accel/accel.h"
#include "renderlib/geometry/intersect.h"
#include "renderlib/geometry/sphere_uv.h"
#include "renderlib/geometry/surface.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/math/constants.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/wide.h"

namespace bandsaw {
namespace {

using test::tries;
using test::Wide;
using test::wide_sqrt;
using test::WideVec;

constexpr double kUnit = 0x1p-53;

/// Returns the ray's parameter t at the hit; std::nullopt if the ray misses. `starts_on_it`: the
/// ray starts on the sphere, so the near root is not a hit.
std::optional<double> hit(const Ray& ray, const Sphere& sphere, bool starts_on_it = false) {
  Crossing crossing;
  if (!intersect(trace_setup(ray.origin, ray.direction, ray.t_max), sphere, starts_on_it,
                 crossing)) {
    return std::nullopt;
  }
  return crossing.t;
}

/// The squared distance of the ray's line from the sphere's centre, and the ray's parameter at both
/// intersections, without rounding.
struct Truth {
  Wide offset2;
  Wide near;
  Wide far;
};

Truth truth(const Ray& ray, const Sphere& sphere) {
  const WideVec f = WideVec(ray.origin) - sphere.center;
  const WideVec d = ray.direction;
  const Wide a = dot(d, d);
  const Wide b = -dot(f, d);
  const WideVec closest = f + d * (b / a);
  const Wide offset2 = dot(closest, closest);
  const Wide r = sphere.radius;
  const Wide half_chord = wide_sqrt(a * (r * r - offset2));
  return {offset2, (b - half_chord) / a, (b + half_chord) / a};
}

TEST(Sphere, S1_IsHitCorrectlyFromFarAway) {
  test::Random random(1);
  // run.sh uses the second number of tries, and the default tests use the first.
  const int rays = tries(20'000, 1'000'000);
  for (const double distance : {150.0, 1.5e3, 1.5e4, 1.5e6}) {
    double square_error = 0;
    int hits = 0;
    int wrong = 0;
    for (int i = 0; i < rays; ++i) {
      const Vec3 center = 0.5 * test::random_point(random) + Vec3{0.5, 0.5, 0.5};
      const Sphere sphere = {center, 1, {}};
      const Vec3 origin = center + distance * test::random_direction(random);
      const Vec3 aim = test::random_direction(random);
      const Ray ray = {origin,
                       normalize(center + 1.05 * std::cbrt(random.uniform()) * aim - origin)};
      const Truth t = truth(ray, sphere);
      const auto found = hit(ray, sphere);
      wrong += found.has_value() != (t.offset2 < 1) ? 1 : 0;
      if (found && t.offset2 < 0.999) {
        const double error = static_cast<double>(*found - t.near);
        square_error += error * error;
        ++hits;
      }
    }
    ASSERT_GT(hits, rays / 2);
    const std::string at = " at distance " + std::to_string(static_cast<int>(distance)) + " R";
    test::at_most("S1", "rays with a wrong hit or miss, of " + std::to_string(rays) + at, wrong, 0);
    test::at_most("S1", "RMS error of t" + at, std::sqrt(square_error / hits),
                  distance <= 1500 ? 1e-10 : 1e-7);
  }
}

TEST(Sphere, S3_TangentRaysAreDecidedCorrectlyAndNeverNan) {
  test::Random random(2);
  for (const double distance : {2.0, 1e3}) {
    for (int k = 3; k <= 15; ++k) {
      for (int i = 0; i < 1000; ++i) {
        const double b = 1 + (i % 2 == 0 ? -1 : 1) * std::pow(10, -k);
        const Sphere sphere = {{0.3, -0.2, 0.1}, 1, {}};
        const Vec3 d = test::random_direction(random);
        const Vec3 across = normalize(cross(d, test::random_direction(random)));
        const Ray ray = {sphere.center + b * across - distance * d, d};
        const Wide offset2 = truth(ray, sphere).offset2;
        const double margin = std::abs(static_cast<double>(wide_sqrt(offset2) - 1));
        const auto found = hit(ray, sphere);
        if (margin > 16 * kUnit * (1 + distance)) {
          ASSERT_EQ(found.has_value(), offset2 < 1) << k;
        }
        if (found) {
          ASSERT_NEAR(*found, distance, 0.2);
        }
      }
    }
  }
  test::report_hard_case("S3",
                         "26,000 rays: hit or miss is correct if the ray passes the rim by more "
                         "than 16 u (R + distance of the origin); t is never NaN");
}

TEST(Sphere, S2_HitPointsLieOnSpheresOfAnySize) {
  test::Random random(3);
  const int rays = tries(20'000, 1'000'000);
  test::Worst height;
  int again = 0;
  for (const double radius : {1e3, 1e5, 1e7}) {
    Geometry g;
    g.spheres.push_back({{0, -radius, 0}, radius, {}});
    for (int i = 0; i < rays; ++i) {
      const Vec3 origin = {0, 1, 0};
      const Vec3 target = {random.uniform(-20, 20), 0, random.uniform(-20, 20)};
      const Ray ray = {origin, target - origin};
      const auto t = hit(ray, g.spheres[0]);
      if (!t) {
        continue;
      }
      const SurfacePoint p = surface_at(g, ray, {*t, {0, 0}, 0, 0});
      if (i % 16 == 0) {
        const Wide off = length(WideVec(p.position) - g.spheres[0].center) - radius;
        height.see(std::abs(static_cast<double>(off)) / (radius + 1));
      }
      const Vec3 up = test::random_direction(random);
      const Ray away = spawn_ray(p, dot(up, p.geometric_normal) < 0 ? -up : up);
      again += hit(away, g.spheres[0], true) || hit(away, g.spheres[0], false) ? 1 : 0;
    }
  }
  test::at_most("S2", "distance of hit points from the sphere, in units of u (R + |o|)",
                height.value() / kUnit, 4);
  test::at_most("S2", "rays that hit the sphere that they leave, of " + std::to_string(3 * rays),
                again, 0);
}

/// Returns the largest relative change of the far root if the last bit of one coordinate of the
/// ray's origin changes.
double change_by_last_bit(const Ray& ray, const Sphere& sphere) {
  const Wide far = truth(ray, sphere).far;
  double most = 0;
  for (double Vec3::*axis : {&Vec3::x, &Vec3::y, &Vec3::z}) {
    Ray moved = ray;
    moved.origin.*axis = std::nextafter(ray.origin.*axis, kInfinity);
    most = std::max(most, std::abs(static_cast<double>(truth(moved, sphere).far / far - 1)));
  }
  return most;
}

TEST(Sphere, S4_TheFarSideIsHitFromWithin) {
  test::Random random(4);
  const Sphere sphere = {{1, 2, 3}, 2, {}};
  test::Worst error;
  test::Worst flat_error;
  test::Worst over_last_bit;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 n = test::random_direction(random);
    const Vec3 d = test::random_direction(random);
    const double just_off = i % 2 == 0 ? 1 : 1 + 2 * kUnit;
    const double cosine = -dot(n, d);
    if (cosine < 1e-3) {
      continue;
    }
    const Ray ray = {sphere.center + 2 * just_off * n, d};
    const auto t = hit(ray, sphere, true);
    ASSERT_TRUE(t);  // t of the near root would be 0
    const double relative = std::abs(static_cast<double>(*t / truth(ray, sphere).far - 1));
    if (cosine > 0.03) {
      error.see(relative);
    } else {
      flat_error.see(relative * cosine * cosine);
      over_last_bit.see(relative / change_by_last_bit(ray, sphere));
    }
  }
  test::at_most("S4", "relative error of t of the far root, for chords steeper than 1.7 degrees",
                error.value(), 1e-12);
  // The discriminant of the roots is R^2 cos^2, and it is rounded with an error of about u R^2. The
  // relative error of the discriminant is therefore about u / cos^2, which is large for flat
  // chords.
  test::at_most("S4", "relative error of t times cos^2, for chords flatter than 1.7 degrees",
                flat_error.value(), 1e-15);
  test::at_most("S4",
                "relative error of t for chords flatter than 1.7 degrees, divided by the relative "
                "change of t if the last bit of the origin changes",
                over_last_bit.value(), 8);
  EXPECT_EQ(hit({sphere.center, {0, 1, 0}}, sphere), 2);
}

TEST(Sphere, S5_TakesTheFirstRootAhead) {
  const Sphere sphere = {{0, 0, 0}, 1, {}};
  EXPECT_EQ(hit({{0, 0, -3}, {0, 0, 1}}, sphere), 2);
  EXPECT_EQ(hit({{0, 0, 0.5}, {0, 0, 1}}, sphere), 0.5);
  EXPECT_FALSE(hit({{0, 0, 3}, {0, 0, 1}}, sphere));
  EXPECT_FALSE(hit({{0, 0, -3}, {0, 0, 1}, 2}, sphere));
  EXPECT_EQ(hit({{0, 0, -3}, {0, 0, 1}}, sphere, true), 4);
  test::report_hard_case("S5", "t is exact for origins before, inside and behind the sphere");
}

TEST(Sphere, S6_TheLengthOfTheDirectionDoesNotMatter) {
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
      ASSERT_EQ(*small, *t * 0x1p40);
      ASSERT_EQ(*large, *t * 0x1p-40);
    }
  }
  test::report_hard_case(
      "S6", "1,000 rays: hits equal to the bit for directions scaled by 2^-40, 1, 2^40");
}

TEST(Sphere, S7_RaysThatEnterATinySphereAlsoLeaveIt) {
  test::Random random(6);
  const int rays = tries(20'000, 1'000'000);
  for (const double radius : {1e-4, 1e-6}) {
    Geometry g;
    g.spheres.push_back({{0.3, 0.4, 0.5}, radius, {}});
    int holes = 0;
    for (int i = 0; i < rays; ++i) {
      const Vec3 origin = g.spheres[0].center + test::random_direction(random);
      const Vec3 target = g.spheres[0].center + 0.99 * radius * test::random_direction(random);
      const Ray ray = {origin, normalize(target - origin)};
      const auto t = hit(ray, g.spheres[0]);
      holes += t && hit(spawn_ray(surface_at(g, ray, {*t, {0, 0}, 0, 0}), ray.direction),
                        g.spheres[0], true)
                   ? 0
                   : 1;
    }
    test::at_most("S7", "rays that find no exit, of " + std::to_string(rays), holes, 0);
  }
}

TEST(SphereUv, HasThePolesOnTheYAxis) {
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

TEST(SphereUv, S8_StaysInTheUnitSquare) {
  test::Random random(7);
  const int points = tries(200'000, 10'000'000);
  int outside = 0;
  for (int i = 0; i < points; ++i) {
    Vec3 n = test::random_direction(random);
    if (i % 3 == 0) {
      n = normalize(Vec3{-1, n.y, n.z * 1e-17});  // along the seam
    }
    if (i % 5 == 0) {
      n.y = std::copysign(1 + kUnit * 2, n.y);  // a pole, beyond it by one rounding
    }
    const Vec2 uv = sphere_uv(n);
    outside += uv.x >= 0 && uv.x < 1 && uv.y >= 0 && uv.y <= 1 ? 0 : 1;
  }
  test::at_most("S8", "points with u or v NaN or outside [0, 1], of " + std::to_string(points),
                outside, 0);
}

/// Traces a ray that is refracted at each hit and never reflected. Sets `direction` to the
/// direction after the last refraction. Returns a letter for each hit: o for the outer sphere, i
/// for the inner sphere. Stops after 9 hits. If no direction can be sampled at a hit, stops at this
/// hit, adds the letter "?" and leaves `direction` unchanged.
std::string pass_through(const Geometry& g, const Accel& accel, Vec3& direction, Vec3 origin) {
  const Material glass = Dielectric{1.5};
  const Material air = Dielectric{1};
  std::string order;
  Ray ray = {origin, direction};
  for (Hit hit = accel.closest(ray); hit && order.size() < 9; hit = accel.closest(ray)) {
    order += hit.id.primitive == 0 ? 'o' : 'i';
    const SurfacePoint p = surface_at(g, ray, hit);
    const bool outer = hit.id.primitive == 0;
    const Bsdf bsdf = bsdf_at(outer ? glass : air, {}, p, -ray.direction, outer ? 1 : 1.5);
    const auto next = sample(bsdf, 0, 0, kOneMinusEpsilon);
    if (!next) {
      return order + "?";
    }
    ray = spawn_ray(p, next->wi);
  }
  direction = ray.direction;
  return order;
}

// A ray at distance b from the centre hits the outer sphere twice and the inner sphere twice. At a
// sphere of radius r and index n, the ray turns by asin(b / r) - asin(b / (n r)). At the outer
// sphere the ray turns towards the centre, at the inner sphere away from the centre.
TEST(Sphere, S10M9_ShellsAndBubblesRefractBySnellsLaw) {
  for (const long double inner : {1 - 1e-9L, 0.5L}) {
    Geometry g;
    g.spheres = {{{0, 0, 0}, 1, {}}, {{0, 0, 0}, static_cast<double>(inner), {}}};
    Pool pool(1);
    const Accel accel = Accel::build(g, pool);
    test::Random random(8);
    test::Worst error;
    for (int i = 0; i < 20'000; ++i) {
      // Rays beyond the critical angle of the bubble are left out, because they are reflected.
      const double b = 0.95 * random.uniform() * static_cast<double>(inner);
      Vec3 direction = {0, 0, 1};
      ASSERT_EQ(pass_through(g, accel, direction, {b, 0, -3}), "oiio");
      const auto bend = [&](long double r) { return std::asin(b / r) - std::asin(b / (1.5L * r)); };
      const long double turn = 2 * (bend(1) - bend(inner));
      error.see(std::abs(std::atan2(-direction.x, direction.z) - static_cast<double>(turn)));
    }
    test::at_most(inner > 0.9L ? "S10" : "M9",
                  inner > 0.9L
                      ? "error of the transmitted direction, in rad"
                      : "bubble of air in glass: error of the transmitted direction, in rad",
                  error.value(), 1e-9);
  }
}

}  // namespace
}  // namespace bandsaw
