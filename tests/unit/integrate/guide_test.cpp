// The guides of the denoiser: an image of the albedo, and an image of the normal and the distance
// (`shape`). guide_value() is tested along single camera rays. guide_sample() takes more rays where
// their values differ.

#include "renderlib/integrate/guide.h"

#include <gtest/gtest.h>

#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

using test::SceneMaker;

Rgb value(const SceneMaker& maker, Integrator integrator, const Ray& ray,
          std::uint64_t number = 0) {
  std::uint64_t rays = 0;
  return guide_value(*maker.build(), integrator, ray, PixelSampler(1, 2, 3), number, rays);
}

const Ray kAhead{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};

TEST(Guide, IsThatOfTheFirstSurfaceThatIsNoMirror) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}), -2);
  EXPECT_EQ(value(maker, kGuideAlbedo, kAhead), (Rgb{0.2f, 0.4f, 0.6f}));
  // The blue channel of kGuideShape is the length of the path to the surface.
  EXPECT_EQ(value(maker, kGuideShape, kAhead).b, 7);
  // A mirror that faces the camera shows the wall behind it.
  SceneMaker mirror;
  mirror.wall(mirror.metal(0.5f, 0), 0);
  mirror.wall(mirror.diffuse({0.2f, 0.4f, 0.6f}), 8);
  EXPECT_EQ(value(mirror, kGuideAlbedo, kAhead), (Rgb{0.1f, 0.2f, 0.3f}));
  EXPECT_NEAR(value(mirror, kGuideShape, kAhead).b, 5 + 8, 1e-4);
}

TEST(Guide, FollowsTheBrighterOfReflectionAndRefractionInGlass) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}), -2);
  maker.sphere({0, 0, 0}, 1, maker.glass(1.5));
  // Straight ahead, nearly all light is refracted: the guides show the wall behind the sphere.
  // At the edge of the sphere, nearly all light is reflected, past the sphere to the wall.
  const Ray edge{.origin = {0.9999, 0, 5}, .direction = {0, 0, -1}};
  for (const Ray& ray : {kAhead, edge}) {
    for (std::uint64_t sample = 0; sample < 100; ++sample) {
      EXPECT_EQ(value(maker, kGuideAlbedo, ray, sample), (Rgb{0.2f, 0.4f, 0.6f})) << sample;
      EXPECT_EQ(value(maker, kGuideShape, ray, sample), value(maker, kGuideShape, ray)) << sample;
    }
  }
}

TEST(Guide, ShowsWhatIsBehindAPane) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}), -2);
  maker.wall(maker.material(ThinDielectric{.transmission = gray(0.5f)}), 1);
  for (std::uint64_t sample = 0; sample < 100; ++sample) {
    EXPECT_EQ(value(maker, kGuideShape, kAhead, sample).b, 7) << sample;
    // The pane's own albedo is near white.
    EXPECT_LT(value(maker, kGuideAlbedo, kAhead, sample).r, 0.11f) << sample;
  }
}

/// The value of a pixel, and how many rays it took.
struct Taken {
  Rgb value;
  std::uint64_t rays = 0;
};

/// Takes sample 5 of a guide of the pixel [0, 1] x [0, 1], of which all camera rays have the
/// direction -z.
Taken taken(const SceneMaker& maker, Integrator integrator) {
  const PixelSampler sampler(1, 2, 3);
  const auto camera = [&](std::uint64_t number, double spread) {
    const Sample4 at = sampler.group(number, kGroupCamera);
    return Ray{.origin = {0.5 + spread * (at[0] - 0.5), 0.5 + spread * (at[1] - 0.5), 5},
               .direction = {0, 0, -1}};
  };
  Taken taken;
  taken.value = guide_sample(*maker.build(), integrator, sampler, 5, camera, taken.rays);
  return taken;
}

/// Returns a scene with two walls, of which the right one begins at x = `edge`.
SceneMaker two_walls(float left, float right, double edge, double depth_of_right = 0) {
  SceneMaker maker;
  maker.quad({edge - 50, -50, 0}, {50, 0, 0}, {0, 100, 0}, maker.diffuse(gray(left)));
  maker.quad({edge, -50, -depth_of_right}, {50, 0, 0}, {0, 100, 0}, maker.diffuse(gray(right)));
  return maker;
}

TEST(Guide, TakesFourRaysOfAnEvenSurface) {
  SceneMaker maker;
  maker.wall(maker.diffuse({0.2f, 0.4f, 0.6f}));
  const Taken albedo = taken(maker, kGuideAlbedo);
  EXPECT_EQ(albedo.rays, 4u);
  EXPECT_NEAR(albedo.value.g, 0.4, 1e-6);
  const Taken shape = taken(maker, kGuideShape);
  EXPECT_EQ(shape.rays, 4u);
  EXPECT_NEAR(shape.value.b, 5, 1e-5);
}

// The first coordinates of 2^k successive samples lie one each in 2^k equal parts of [0, 1], so the
// share of an edge's right side is wrong by less than one ray.
TEST(Guide, TakesThirtyTwoRaysAcrossASharpEdge) {
  const Taken albedo = taken(two_walls(0, 1, 0.7), kGuideAlbedo);
  EXPECT_EQ(albedo.rays, 4u + 32u);
  EXPECT_NEAR(albedo.value.r, 0.3, 1.0 / 32);
  const Taken shape = taken(two_walls(1, 1, 0.7, 5), kGuideShape);
  EXPECT_EQ(shape.rays, 4u + 32u);
  EXPECT_NEAR(shape.value.b, 0.7 * 5 + 0.3 * 10, 5.0 / 32);
}

TEST(Guide, TakesEightRaysAcrossAFaintEdge) {
  const Taken albedo = taken(two_walls(0.4f, 0.6f, 0.7), kGuideAlbedo);
  EXPECT_EQ(albedo.rays, 4u + 8u);
  EXPECT_NEAR(albedo.value.r, 0.46, 0.2 / 8);
}

// The outer one of four rays over two pixels' width is beyond the pixel's own edge.
TEST(Guide, NoticesAnEdgeBesideThePixelButDoesNotTakeItsColour) {
  const Taken albedo = taken(two_walls(0, 1, 1), kGuideAlbedo);
  EXPECT_EQ(albedo.rays, 4u + 32u);
  EXPECT_EQ(albedo.value.r, 0);
}

}  // namespace
}  // namespace bandsaw
