// Tests the hard cases C1, M9, O6, Q4 and T13 (cases.txt), which need a whole scene.

#include <gtest/gtest.h>

#include <cmath>
#include <sstream>

#include "renderlib/camera/camera.h"
#include "renderlib/math/constants.h"
#include "tests/statistical/estimate.h"
#include "tests/support/hard_case.h"
#include "tests/support/meshes.h"
#include "tests/support/scenes.h"

namespace bandsaw {
namespace {

/// Returns a scene of a white ball, which is a mesh of slices and stacks, under one directional
/// light. `smooth`: the mesh has vertex normals.
std::shared_ptr<const Scene> white_ball(int slices, int stacks, bool smooth) {
  Mesh mesh = test::rough_sphere(slices, stacks, 1, 1);
  if (smooth) {
    mesh.normals = mesh.positions;
  }
  test::SceneMaker maker;
  maker.instance(std::move(mesh), {}, maker.diffuse(1));
  // The light comes from the side and a little from behind, so that the camera sees the border
  // between light and shade.
  maker.scene.lights = {DirectionalLight{normalize(Vec3{-1, -0.2, 0.1}), gray(1)}};
  return maker.build();
}

/// Returns the radiance along the ray from (x, y, 5) in direction -z.
double radiance(const Scene& scene, double x, double y) {
  PathCounts counts;
  const Ray ray{.origin = {x, y, 5}, .direction = {0, 0, -1}};
  return path_radiance(scene, ray, PixelSampler(0, 1, 2), 0, {.max_depth = 1}, counts).g;
}

TEST(SmoothNormals, T13_TheErrorOfSmoothNormalsIsAtMostTwiceThatOfFlatNormals) {
  const auto fine = white_ball(1000, 500, true);
  const auto smooth = white_ball(20, 10, true);
  const auto flat = white_ball(20, 10, false);
  double smooth_error = 0;
  double flat_error = 0;
  int bright = 0;
  constexpr int kSide = 200;
  for (int i = 0; i < kSide * kSide; ++i) {
    const double x = 0.96 * (2 * (i % kSide + 0.5) / kSide - 1);
    const double y = 0.96 * (2 * (i / kSide + 0.5) / kSide - 1);
    if (x * x + y * y > 0.92) {
      continue;  // outside of the coarse mesh
    }
    const double truth = radiance(*fine, x, y);
    bright += truth > 0 ? 1 : 0;
    smooth_error += std::abs(radiance(*smooth, x, y) - truth);
    flat_error += std::abs(radiance(*flat, x, y) - truth);
  }
  EXPECT_GT(bright, 5000);
  test::at_most("T13",
                "mean radiance error with smooth normals divided by the mean radiance error with "
                "flat normals",
                smooth_error / flat_error, 2);
}

// The light lies in the plane of the ceiling. The ceiling must neither hide the light from a ray
// nor occlude it from the floor. At the middle of the floor, each quarter of the light gives
// E = a / sqrt(1 + a^2) atan(a / sqrt(1 + a^2)), where a is the side of a quarter over its height.
TEST(Ceiling, Q4_ALightInThePlaneOfTheCeilingGivesTheClosedForm) {
  test::SceneMaker maker;
  maker.quad({-9, 0, -9}, {0, 0, 18}, {18, 0, 0}, maker.diffuse(1));
  maker.quad({-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, maker.lamp(1, true));
  maker.quad({-9, 2, -9}, {18, 0, 0}, {0, 0, 18}, maker.diffuse(0));
  const double a = 0.5;
  const double side = std::sqrt(1 + a * a);
  const double irradiance = 4 * a / side * std::atan(a / side);
  const Ray down{.origin = {0, 0.5, 0}, .direction = {0, -1, 0}};
  const test::Moments seen = test::radiance_along(*maker.build(), down, {.max_depth = 1}, 1024);
  EXPECT_LE(seen.standard_error(), 1e-3 * seen.mean());
  test::at_most("Q4", "error of the floor's radiance, in standard errors",
                std::abs(seen.z(irradiance / kPi)), 4);
  const Ray up{.origin = {0.3, 1, 0.2}, .direction = {0, 1, 0}};
  EXPECT_EQ(test::radiance_along(*maker.build(), up, {}, 16).mean(), 1);
}

// A face of the pane has the reflectance R = 0.04. The pane transmits (1 - R) / (1 + R), the sum
// over all reflections between the faces.
TEST(Pane, O6_TransmitsTheSameShareAtAnyThickness) {
  for (const double thickness : {1e-3, 1e-6, 1e-9}) {
    test::SceneMaker maker;
    const MaterialId glass = maker.glass(1.5);
    maker.quad({-9, 1, -9}, {0, 0, 18}, {18, 0, 0}, glass);
    maker.quad({-9, 1 - thickness, -9}, {18, 0, 0}, {0, 0, 18}, glass);
    maker.background(gray(0), gray(1));
    const Ray up{.origin = {0, 0, 0}, .direction = {0, 1, 0}};
    const test::Moments seen = test::radiance_along(*maker.build(), up, {.max_depth = 1000}, 4096);
    EXPECT_LE(std::abs(seen.z(0.96 / 1.04)), 4);
    std::ostringstream what;
    what << "pane of thickness " << thickness << ": error of the transmitted share";
    test::at_most("O6", what.str(), std::abs(seen.mean() - 0.96 / 1.04), 1e-3);
  }
}

/// Measures the light along a ray that goes down at 45 degrees through two slabs: glass at heights
/// from 0 to 1, water from 1 - overlap to 2. The only emitter is a narrow strip. A correctly
/// refracted ray hits this strip after it has left the glass.
test::Moments through_water_and_glass(double overlap) {
  constexpr double kFar = 100;
  test::SceneMaker maker;
  const auto slab = [&](double low, double high, const Dielectric& inside) {
    const MaterialId material = maker.material(inside);
    maker.quad({-kFar, high, -kFar}, {0, 0, 2 * kFar}, {2 * kFar, 0, 0}, material);
    maker.quad({-kFar, low, -kFar}, {2 * kFar, 0, 0}, {0, 0, 2 * kFar}, material);
  };
  slab(1 - overlap, 2, {1.33, /*roughness=*/0, /*priority=*/1});
  slab(0, 1, {1.5, /*roughness=*/0, /*priority=*/2});
  const double s = std::sqrt(0.5);
  const auto aside = [&](double index) { return s / std::sqrt(index * index - s * s); };
  const double x = aside(1.33) + aside(1.5) + 1;
  maker.quad({x - 1e-6, -1, -1}, {2e-6, 0, 0}, {0, 0, 2}, maker.lamp(1));
  const Ray ray{.origin = {-1, 3, 0}, .direction = normalize({1, -1, 0})};
  return test::radiance_along(*maker.build(), ray, {}, 4096);
}

TEST(NestedGlass, M9_AnySizeOfTheOverlapGivesTheSameLight) {
  const double truth = through_water_and_glass(0.1).mean();
  EXPECT_GT(truth, 0.85);
  test::at_most(
      "M9",
      "light that passes with an overlap of 1e-6: difference from the light with an overlap of 0.1",
      std::abs(through_water_and_glass(1e-6).mean() - truth), 1e-3);
  test::at_most(
      "M9",
      "light that passes with faces in one plane: difference from the light with an overlap of 0.1",
      std::abs(through_water_and_glass(0).mean() - truth), 1e-3);
}

/// Returns 60 spheres and a mesh around the point `at`, with a camera that looks at this point.
test::SceneMaker spheres_and_mesh(const Vec3& at) {
  test::SceneMaker maker;
  const MaterialId white = maker.diffuse(0.5f);
  test::Random random(4);
  for (int i = 0; i < 60; ++i) {
    const Vec3 p = 3 * test::random_point(random);
    maker.sphere(at + p, 0.3, white);
  }
  maker.instance(test::icosphere(3), translation(at) * scaling({2, 1, 2}), white);
  PerspectiveCamera camera{.position = at + Vec3{0, 1, 9}, .look_at = at};
  camera.vertical_fov = 40;
  maker.scene.camera = camera;
  return maker;
}

TEST(Camera, C1_TheSamePrimitivesAreHitAMillionUnitsAway) {
  const auto near = spheres_and_mesh({0, 0, 0}).build();
  const auto far = spheres_and_mesh({1e6, -1e6, 1e6}).build();
  constexpr std::uint32_t kSide = 500;
  const RayGenerator near_rays(near->camera(), kSide, kSide);
  const RayGenerator far_rays(far->camera(), kSide, kSide);
  int different = 0;
  int hits = 0;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i) {
    const double x = i % kSide + 0.37;
    const double y = i / kSide + 0.61;
    const Hit a = near->accel().closest(near_rays.ray(x, y, 0, 0));
    const Hit b = far->accel().closest(far_rays.ray(x, y, 0, 0));
    hits += a ? 1 : 0;
    different += a.id == b.id ? 0 : 1;
  }
  EXPECT_GT(hits, 50'000);
  test::at_most("C1", "share of 250,000 camera rays that hit another primitive 1e6 away",
                different / 250'000.0, 1e-5);
}

}  // namespace
}  // namespace bandsaw
