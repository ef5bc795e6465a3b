// Tests lights that are out of focus. Such a light is seen as a disk. The radiance of the disk is
// the radiance of the light times the share of the lens from which the light is visible. The mean
// is the same with and without light sampling through the lens.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/integrate/path_reuse.h"
#include "tests/statistical/estimate.h"
#include "tests/support/media.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Returns a camera at the origin that looks along -z and is focused at the distance 4.
PerspectiveCamera camera(double aperture) {
  return {.look_at = {0, 0, -1}, .aperture = aperture, .focus_distance = 4};
}

/// How a light that the camera sees is found: by camera rays that happen to hit it, or also by
/// light sampling through the lens.
enum class Technique { kBsdfSampling, kLightSampling };

/// Returns the radiance at position (x, y) of an image of 20 x 20 pixels.
Moments seen(const SceneMaker& maker, const PerspectiveCamera& camera, double x, double y,
             Technique technique, std::uint64_t samples,
             const PathOptions& options = {.max_depth = 8}) {
  const auto scene = maker.build();
  const RayGenerator rays(camera, 20, 20);
  Moments means;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    const PixelSampler sampler(seed, 11, 7);
    double sum = 0;
    PathCounts counts;
    for (std::uint64_t sample = 0; sample < samples; ++sample) {
      const Sample4 at = sampler.group(sample, kGroupCamera);
      CameraRay ray(rays.ray(x, y, at[2], at[3]));
      if (technique == Technique::kLightSampling) {
        ray.lens = rays.lens_view(x, y);
      }
      sum += path_radiance(*scene, ray, sampler, sample, options, counts).g;
    }
    means.add(sum / static_cast<double>(samples));
  }
  return means;
}

/// Expects that the mean is `expected` within 4 standard errors. `relative_error`: the largest
/// standard error that is accepted, relative to `expected`.
void expect_value(const Moments& radiance, double expected, double relative_error) {
  EXPECT_NEAR(radiance.mean(), expected, 4 * radiance.standard_error() + 1e-6 * expected);
  EXPECT_LE(radiance.standard_error(), relative_error * expected);
}

/// The camera rays of the middle of the image pass through the focus, which is the point of the
/// camera's axis at the distance 4. The rays through the focus that hit a ball on the axis form a
/// cone. Returns the share of the lens that lies within this cone.
double share_of_lens(double radius, double distance, double aperture) {
  const double sine = radius / std::abs(distance - 4);
  const double on_lens = 4 * sine / std::sqrt((1 - sine) * (1 + sine));
  return on_lens * on_lens / (aperture * aperture / 4);
}

TEST(Lens, ALightBeyondTheFocusIsADisk) {
  // The last light is visible from a millionth of the lens: of 8,192 rays, hardly one would hit it.
  for (const double radius : {0.1, 0.01, 3e-4}) {
    SceneMaker maker;
    maker.sphere({0, 0, -10}, radius, maker.lamp(7));
    expect_value(seen(maker, camera(0.4), 10, 10, Technique::kLightSampling, 256),
                 7 * share_of_lens(radius, 10, 0.4), 1e-3);
  }
}

TEST(Lens, ALightBeforeTheFocusIsADisk) {
  SceneMaker maker;
  maker.sphere({0, 0, -2}, 0.05, maker.lamp(7));
  for (const Technique technique : {Technique::kLightSampling, Technique::kBsdfSampling}) {
    expect_value(seen(maker, camera(0.4), 10, 10, technique, 4096), 7 * share_of_lens(0.05, 2, 0.4),
                 1e-2);
  }
}

/// Expects that both techniques have the same mean, and that light sampling has hardly more noise.
void expect_the_same(const SceneMaker& maker, const PerspectiveCamera& camera,
                     std::uint64_t samples = 4096) {
  // The places are the middle, the edge of a disk, a point between disks and a corner.
  for (const double place : {10.0, 10.7, 12.5, 19.5}) {
    const Moments sampled =
        seen(maker, camera, place, 20 - place, Technique::kLightSampling, samples);
    const Moments by_chance =
        seen(maker, camera, place, 20 - place, Technique::kBsdfSampling, samples);
    EXPECT_NEAR(sampled.mean(), by_chance.mean(),
                4 * std::hypot(sampled.standard_error(), by_chance.standard_error()))
        << "at " << place;
    EXPECT_LE(sampled.standard_error(), 1.1 * by_chance.standard_error() + 1e-4 * sampled.mean())
        << "at " << place;
  }
}

/// Returns a scene with spheres, a quad and a triangle that emit light in front of, in and beyond
/// the focus. One of the lamps is behind a ball. A point light and a directional light, which the
/// camera does not see, are in the scene too.
SceneMaker lamps() {
  SceneMaker maker;
  maker.quad({-9, -2, -30}, {18, 0, 0}, {0, 0, 40}, maker.diffuse(0.6f));
  maker.sphere({0.3, 0.1, -9}, 0.2, maker.lamp(4));
  maker.quad({1, -1.5, -12}, {0.5, 0, 0}, {0, 0.7, 0}, maker.lamp(3));
  maker.triangle({-1, 0, -7}, {-0.5, 0, -7}, {-0.7, 0.6, -8}, maker.lamp(2, true));
  maker.sphere({-0.2, 0.2, -4}, 0.3, maker.lamp(1.5f));
  maker.sphere({0.05, -0.3, -2}, 0.02, maker.lamp(5));
  maker.sphere({0.4, -0.2, -6}, 0.4, maker.diffuse(0.5f));
  maker.scene.lights = {PointLight{{0, 1, -8}, gray(2)},
                        DirectionalLight{normalize({0, -1, 0.1}), gray(0.3f)}};
  return maker;
}

TEST(Lens, LightSamplingAndCameraRaysHaveTheSameMean) {
  expect_the_same(lamps(), camera(0.4));
  expect_the_same(lamps(), camera(3));
}

TEST(Lens, LightSamplingAndCameraRaysHaveTheSameMeanAmongManyLights) {
  SceneMaker maker = lamps();
  for (int i = 0; i < 40; ++i) {
    maker.sphere({std::sin(i) * 3, std::cos(3 * i) * 2, -8.0 - i % 7}, 0.1, maker.lamp(3));
  }
  expect_the_same(maker, camera(0.6));
}

TEST(Lens, LightSamplingAndCameraRaysHaveTheSameMeanInFogAndUnderASky) {
  SceneMaker maker = lamps();
  maker.background(gray(0.2f), gray(0.7f));
  test::fog(maker, test::medium(0.02f, 0.1f, 0.3));
  expect_the_same(maker, camera(0.4), 512);
}

TEST(Lens, HiddenLampsBeyondTheFocusAreNotSeen) {
  SceneMaker maker;
  const MaterialId lamp = maker.lamp(7);
  std::get<Emissive>(maker.scene.materials[index_of(lamp)].kind).hidden = true;
  maker.sphere({0, 0, -10}, 0.1, lamp);
  EXPECT_EQ(seen(maker, camera(0.4), 10, 10, Technique::kLightSampling, 256).mean(), 0);
}

/// Returns a closed room with two lamps. In such a scene the pixels of a group share parts of their
/// paths (path reuse).
SceneMaker room() {
  SceneMaker maker;
  const MaterialId wall = maker.diffuse(0.5f);
  const Vec3 low{-3, -3, -12};
  const Vec3 x{6, 0, 0};
  const Vec3 y{0, 6, 0};
  const Vec3 z{0, 0, 14};
  for (const Vec3& corner : {low, low + z}) {
    maker.quad(corner, x, y, wall);
  }
  for (const Vec3& corner : {low, low + x}) {
    maker.quad(corner, y, z, wall);
  }
  for (const Vec3& corner : {low, low + y}) {
    maker.quad(corner, x, z, wall);
  }
  maker.sphere({0, 0.2, -9}, 0.1, maker.lamp(8));
  maker.sphere({0.9, -0.1, -7}, 0.05, maker.lamp(8));
  return maker;
}

TEST(Lens, LightsAreSampledThroughTheLensWithPathReuse) {
  const auto scene = room().build();
  ASSERT_TRUE(scene->reuses_paths());
  const RayGenerator rays(camera(0.4), 20, 20);
  constexpr double kRow = 10.3;
  std::array<Moments, kMaxReusePixels> shared;
  for (std::uint64_t seed = 0; seed < 32; ++seed) {
    std::vector<ReusePixel> pixels;
    for (std::uint32_t x = 0; x < kMaxReusePixels; ++x) {
      pixels.push_back({.sampler = PixelSampler(seed, x, 3), .camera_ray = Ray{}});
    }
    std::array<double, kMaxReusePixels> sums{};
    for (std::uint64_t sample = 0; sample < 512; ++sample) {
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        const Sample4 at = pixels[i].sampler.group(sample, kGroupCamera);
        const double place = 7 + static_cast<double>(i);
        pixels[i].camera_ray = rays.ray(place, kRow, at[2], at[3]);
        pixels[i].camera_ray.lens = rays.lens_view(place, kRow);
      }
      radiance_with_reuse(*scene, absl::MakeSpan(pixels), sample, {.max_depth = 3});
      for (std::size_t i = 0; i < pixels.size(); ++i) {
        sums[i] += pixels[i].radiance.g;
      }
    }
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      shared[i].add(sums[i] / 512);
    }
  }
  for (std::size_t i = 0; i < shared.size(); ++i) {
    const Moments alone = seen(room(), camera(0.4), 7 + static_cast<double>(i), kRow,
                               Technique::kBsdfSampling, 512, {.max_depth = 3});
    EXPECT_NEAR(shared[i].mean(), alone.mean(),
                4 * std::hypot(shared[i].standard_error(), alone.standard_error()))
        << "pixel " << i;
    EXPECT_LE(shared[i].standard_error(), alone.standard_error()) << "pixel " << i;
  }
}

}  // namespace
}  // namespace bandsaw
