// Compares balls of glass and media that are squashed or stretched by many orders of magnitude,
// under a white sky, with closed forms. An id such as S12 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/media.h"
#include "tests/support/meshes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::Random;
using test::SceneMaker;

constexpr double kThin[] = {1e-3, 1e-6, 1e-7, 1e-9};

/// Returns the placement of a ball of radius 1 that is squashed by the factor `by` along one axis
/// and stretched along another, rotated and moved.
Transform squashed(double by) {
  return translation({0.3, -0.2, 0.1}) * rotation({1, 2, 3}, 40) * scaling({1, by, 3}) *
         rotation({2, 1, -1}, 70);
}

SceneMaker white_sky() {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  return maker;
}

/// Returns an instance of group 0, a ball of radius 1.
Instance ball(const Transform& to_world, MaterialId material) {
  Instance instance;
  instance.group = GroupId{0};
  instance.material = material;
  instance.to_world = to_world;
  return instance;
}

/// Adds a ball of glass with the placement `to_world`.
void add_glass(SceneMaker& maker, const Transform& to_world) {
  maker.scene.geometry.groups.push_back(unit_ball());
  maker.scene.geometry.instances.push_back(ball(to_world, maker.glass(1.5)));
}

/// Adds a ball of the medium, with an invisible surface and the placement `to_world`.
void fill(SceneMaker& maker, const Transform& to_world, const Medium& medium) {
  Geometry& boundaries = maker.scene.media.boundaries;
  boundaries.groups.push_back(unit_ball());
  boundaries.instances.push_back(ball(to_world, filled_with(test::add(maker, medium))));
}

/// Returns a ray to a random point inside the ball with the placement `to_world`. The ray starts at
/// the distance 4 from this point, which is practically always outside, because the ball is thin.
Ray random_ray(const Transform& to_world, Random& random) {
  const Vec3 target = to_world.point(0.57 * test::random_point(random));
  const Vec3 origin = target + 4 * test::random_direction(random);
  return {.origin = origin, .direction = normalize(target - origin)};
}

/// Each path must carry the radiance 1 of the sky. In glass radiance is greater by the squared
/// index, 2.25. So a path whose entry is found and whose exit is missed carries 1 / 2.25 = 0.44. A
/// path whose entry is missed and whose exit is found carries 2.25. A few paths are reflected along
/// the rim inside the ball thousands of times, and are truncated.
TEST(Squashed, S12_AGlassBallIsInvisibleInAWhiteSky) {
  int wrong = 0;
  int paths = 0;
  int cut_off = 0;
  for (const double by : kThin) {
    SceneMaker maker = white_sky();
    add_glass(maker, squashed(by));
    const auto scene = maker.build();
    Random random(1);
    for (int i = 0; i < 20'000; ++i, ++paths) {
      const Ray ray = random_ray(squashed(by), random);
      const PixelSampler sampler(static_cast<std::uint64_t>(i), 3, 5);
      PathCounts counts;
      const float seen = path_radiance(*scene, ray, sampler, 0, {.max_depth = 1000}, counts).g;
      cut_off += counts.truncated > 0 ? 1 : 0;
      wrong += counts.truncated > 0 || std::abs(seen - 1) <= 1e-5 ? 0 : 1;
    }
    EXPECT_EQ(wrong, 0) << by;
  }
  EXPECT_LE(cut_off, paths / 1'000);
  test::at_most("S12",
                "paths through glass balls whose radiance differs from the sky's, of " +
                    std::to_string(paths),
                wrong, 0);
}

/// An absorbing ball transmits exp(-sigma * chord). The length of the chord is computed in the
/// space in which the ball is a unit sphere. Every second ray starts inside the ball.
TEST(Squashed, S12_AnAbsorbingBallTransmitsTheExponentialOfItsChord) {
  test::Worst error;
  for (const double by : kThin) {
    const double sigma = 1 / by;
    const Transform to_object = *inverse(squashed(by));
    SceneMaker maker = white_sky();
    fill(maker, squashed(by), test::medium(static_cast<float>(sigma), 0));
    const auto scene = maker.build();
    Random random(2);
    for (int i = 0; i < 5'000; ++i) {
      Ray ray = random_ray(squashed(by), random);
      const Vec3 target = ray.origin + 4 * ray.direction;
      if (i % 2 == 1) {
        ray.origin = target;
      }
      const Vec3 d = to_object.direction(ray.direction);
      const Vec3 o = to_object.point(target);  // near the ball, because far points lose precision
      const double b = dot(o, d) / length_squared(d);
      const double half = std::sqrt(b * b + (1 - length_squared(o)) / length_squared(d));
      const double chord = i % 2 == 1 ? half - b : 2 * half;
      PathCounts counts;
      const float seen =
          path_radiance(*scene, ray, PixelSampler(1, 2, 3), 0, {.max_depth = 10}, counts).g;
      error.see(std::abs(seen - std::exp(-double{static_cast<float>(sigma)} * chord)));
    }
  }
  test::at_most("S12", "error of the transmittance of absorbing balls", error.value(), 1e-4);
}

/// For a ray through its middle, the ball is a pane with parallel faces, which the ray meets
/// perpendicularly. Each face reflects the share F = 0.04. Of the light that crosses the glass
/// once, the share a = exp(-0.8) is not absorbed. The sky is white on both sides, so the radiance
/// is the sum of what the pane reflects and transmits: F + (1 - F)^2 a (1 + F a) / (1 - F^2 a^2).
TEST(Squashed, S12_AbsorbingGlassIsAPaneInItsMiddle) {
  for (const double by : kThin) {
    const Transform to_world = rotation({1, 2, 3}, 40) * scaling({1, by, 2});
    SceneMaker maker = white_sky();
    add_glass(maker, to_world);
    fill(maker, to_world, test::medium(static_cast<float>(0.4 / by), 0));
    const Vec3 up = rotation({1, 2, 3}, 40).direction({0, 1, 0});
    const Moments seen = test::radiance_along(*maker.build(), {.origin = 3 * up, .direction = -up},
                                              {.max_depth = 1000}, 1024, 32);
    const double f = 0.04;
    const double a = std::exp(-0.8);
    const double expected = f + (1 - f) * (1 - f) * a * (1 + f * a) / (1 - f * f * a * a);
    EXPECT_LE(std::abs(seen.z(expected)), 4) << by << ": " << seen.mean() << " not " << expected;
    EXPECT_LE(seen.standard_error(), 1e-3 * expected) << by;
  }
  test::report_hard_case("S12",
                         "absorbing glass ball: radiance through the middle within 4 SE of a pane");
}

TEST(Squashed, S12_MediaWithoutLossAreInvisibleInAWhiteSky) {
  for (const double by : kThin) {
    for (const bool glass : {false, true}) {
      SceneMaker maker = white_sky();
      if (glass) {
        add_glass(maker, squashed(by));
      }
      fill(maker, squashed(by), test::medium(0, static_cast<float>(2 / by)));
      const auto scene = maker.build();
      Random random(3);
      Moments seen;
      PathCounts counts;
      for (int i = 0; i < 3'000; ++i) {
        const Ray ray = random_ray(squashed(by), random);
        const PixelSampler sampler(static_cast<std::uint64_t>(i), 3, 5);
        seen.add(path_radiance(*scene, ray, sampler, 0, {.max_depth = 1000}, counts).g);
      }
      EXPECT_NEAR(seen.mean(), 1, 1e-4) << by << (glass ? ", in glass" : "");
      EXPECT_LE(seen.standard_error(), 1e-4) << by;
      EXPECT_EQ(counts.truncated, 0u);
    }
  }
  test::report_hard_case(
      "S12", "media without absorption, alone and in glass: radiance within 1e-4 of the sky");
}

}  // namespace
}  // namespace bandsaw
