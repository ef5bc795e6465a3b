// Tests whole paths through media that vary in space. These media are compared with homogeneous
// media, and with the same media in other places. The seeds are fixed, and the z-tests allow 4
// standard errors.

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderlib/integrate/path.h"
#include "tests/support/grids.h"
#include "tests/support/media.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

/// Adds a grid to the scene and returns its id.
GridId add_grid(SceneMaker& maker, VolumeGrid grid) {
  maker.scene.media.grids.push_back(std::move(grid));
  return GridId{static_cast<std::uint32_t>(maker.scene.media.grids.size() - 1)};
}

/// Returns the medium with its coefficients multiplied by the density of this grid.
Medium varying(Medium medium, GridId density) {
  medium.grids.density = GridUse{density, 1};
  return medium;
}

/// A lumpy density in the box from -1 to 1, which is denser towards +x.
VolumeGrid lumps() {
  return test::grid_of({12, 12, 12}, {-1, -1, -1}, {1, 1, 1}, [](auto x, auto y, auto z) {
    return 0.2f * static_cast<float>(x) + static_cast<float>((x * 5 + y * 3 + z * 7) % 4);
  });
}

/// A grid of one density in the box from -1 to 1.
VolumeGrid constant(float density) {
  VolumeGrid grid = test::grid_of({16, 16, 16}, {-1, -1, -1}, {1, 1, 1},
                                  [density](auto, auto, auto) { return density; });
  grid.border = VolumeGrid::Border::kClamp;
  return grid;
}

/// Adds the box from -1 to 1, filled with this medium. The box and its medium move with a frame, a
/// coordinate system that has the transform `placement` and the motion `keys`.
void fill_placed(SceneMaker& maker, MediumId inside, const Transform& placement,
                 std::vector<Key> keys = {Key(0, {})}) {
  test::fill_box(maker, {-1, -1, -1}, {1, 1, 1}, inside);
  Geometry& boundaries = maker.scene.media.boundaries;
  boundaries.frames.push_back({kNoFrame, placement, std::move(keys)});
  boundaries.instances.back().frame =
      FrameId{static_cast<std::uint32_t>(boundaries.frames.size() - 1)};
}

constexpr std::size_t kPixels = 6000;

/// Returns the radiance along the ray of one sample in this pixel.
Rgb one(const Scene& scene, const Ray& ray, std::uint32_t pixel, const PathOptions& options = {}) {
  PathCounts counts;
  return path_radiance(scene, ray, PixelSampler(5, pixel, 3), pixel, options, counts);
}

/// Returns the moments of the green channel.
Moments moments_of(const Scene& scene, const Ray& ray, const PathOptions& options = {}) {
  Moments moments;
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    moments.add(one(scene, ray, pixel, options).g);
  }
  return moments;
}

/// Returns the distance of the two means, in standard errors.
double z(const Moments& a, const Moments& b) {
  return std::abs(a.mean() - b.mean()) / std::hypot(a.standard_error(), b.standard_error());
}

const Ray kAhead{.origin = {0.1, 0.2, 5}, .direction = {0, 0, -1}};

void add_lamp_and_floor(SceneMaker& maker) {
  maker.sphere({2, 2, 1}, 0.5, maker.lamp(20));
  maker.quad({-4, -2, 4}, {8, 0, 0}, {0, 0, -8}, maker.diffuse(0.6f));
}

// In a furnace, nothing absorbs light and the background has the radiance 1 everywhere. So the
// radiance along every ray must be 1.
TEST(GridMedia, NothingIsLostInAFurnace) {
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  const GridId grid = add_grid(maker, lumps());
  test::fill_box(maker, {-1, -1, -1}, {1, 1, 1},
                 test::add(maker, varying({.scattering = {0.5f, 1, 2}, .g = 0.5}, grid)));
  const auto scene = maker.build();
  std::array<Moments, 3> seen;
  for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel) {
    const Rgb value = one(*scene, kAhead, pixel, {.max_depth = 1000});
    // Without absorption, every outcome has the same sum of channels.
    ASSERT_NEAR(value.r + value.g + value.b, 3, 1e-3);
    seen[0].add(value.r);
    seen[1].add(value.g);
    seen[2].add(value.b);
  }
  for (const Moments& channel : seen) {
    EXPECT_LT(std::abs(channel.z(1)), 4);
  }
}

TEST(GridMedia, AConstantDensityIsAHomogeneousMedium) {
  const Medium smoke{
      .absorption = gray(0.1f), .scattering = gray(0.5f), .emission = gray(0.05f), .g = 0.3};
  SceneMaker with_grid;
  add_lamp_and_floor(with_grid);
  SceneMaker without = with_grid;
  const GridId grid = add_grid(with_grid, constant(2));
  test::fill_box(with_grid, {-1, -1, -1}, {1, 1, 1}, test::add(with_grid, varying(smoke, grid)));
  Medium dense = smoke;
  dense.absorption = dense.absorption * 2;
  dense.scattering = dense.scattering * 2;
  dense.emission = dense.emission * 2;
  test::fill_box(without, {-1, -1, -1}, {1, 1, 1}, test::add(without, dense));
  const auto a = with_grid.build();
  const auto b = without.build();
  EXPECT_TRUE(a->features().grids);
  EXPECT_FALSE(b->features().grids);
  const Ray onto_floor{.origin = {0, 1.5, 5}, .direction = normalize(Vec3{0, -0.5, -1})};
  for (const Ray& ray : {kAhead, onto_floor}) {
    for (const std::uint32_t depth : {0u, 1u, 8u}) {
      for (const bool local : {false, true}) {
        const PathOptions options{.max_depth = depth, .local = local};
        EXPECT_LT(z(moments_of(*a, ray, options), moments_of(*b, ray, options)), 4)
            << depth << " " << local;
      }
    }
  }
}

TEST(GridMedia, EachTechniqueReachesTheSameMean) {
  SceneMaker maker;
  add_lamp_and_floor(maker);
  const GridId grid = add_grid(maker, lumps());
  test::fill_box(
      maker, {-1, -1, -1}, {1, 1, 1},
      test::add(maker, varying({.absorption = gray(0.1f), .scattering = gray(0.4f)}, grid)));
  const auto scene = maker.build();
  const Moments both = moments_of(*scene, kAhead);
  EXPECT_GT(both.mean(), 0.01);
  EXPECT_LT(z(both, moments_of(*scene, kAhead, {.technique = Technique::kLightsOnly})), 4);
  EXPECT_LT(z(both, moments_of(*scene, kAhead, {.technique = Technique::kScatteringOnly})), 4);
}

// With the integrator `direct` (PathOptions::local), media do not light each other. A medium that
// emits would make the two results differ, so the medium of this test does not emit.
TEST(GridMedia, DirectEqualsPathsOfOneScattering) {
  SceneMaker maker;
  maker.sphere({2, 2, 1}, 0.5, maker.lamp(20));
  const GridId grid = add_grid(maker, lumps());
  const Medium smoke{.absorption = {0, 0.1f, 1}, .scattering = gray(0.4f)};
  test::fill_box(maker, {-1, -1, -1}, {1, 1, 1}, test::add(maker, varying(smoke, grid)));
  const auto scene = maker.build();
  EXPECT_LT(
      z(moments_of(*scene, kAhead, {.local = true}), moments_of(*scene, kAhead, {.max_depth = 1})),
      4);
}

/// Expects that the two rays have the same value in nearly all pixels. Their random numbers are the
/// same, and rounding changes the outcome of a collision only rarely.
void expect_same(const Scene& a, const Ray& ray_a, const Scene& b, const Ray& ray_b) {
  int differ = 0;
  Moments seen;
  for (std::uint32_t pixel = 0; pixel < 2000; ++pixel) {
    const float first = one(a, ray_a, pixel).g;
    seen.add(first);
    differ += std::abs(first - one(b, ray_b, pixel).g) > 1e-4f * (1 + first) ? 1 : 0;
  }
  EXPECT_LE(differ, 4);
  EXPECT_GT(seen.variance(), 0);
}

const Medium kSmoke{.absorption = gray(0.1f), .scattering = gray(0.4f)};

TEST(GridMedia, AMovedGridLooksTheSameAlongAMovedRay) {
  const auto lit = [](SceneMaker& maker) { maker.background(gray(0.2f), gray(1)); };
  SceneMaker in_place;
  lit(in_place);
  test::fill_box(in_place, {-1, -1, -1}, {1, 1, 1},
                 test::add(in_place, varying(kSmoke, add_grid(in_place, lumps()))));
  const auto in_place_scene = in_place.build();
  // The grid is turned about the vertical axis, about which the background is symmetric.
  const Transform placement = translation({3, 0, -2}) * rotation({0, 1, 0}, 90);
  const Ray moved{.origin = placement.point(kAhead.origin),
                  .direction = placement.direction(kAhead.direction)};
  SceneMaker placed;
  lit(placed);
  const MediumId smoke = test::add(placed, varying(kSmoke, add_grid(placed, lumps())));
  fill_placed(placed, smoke, placement);
  const auto placed_scene = placed.build();
  // Directions after scattering are sampled in a frame that does not turn with the scene. So the
  // paths differ, but their means are the same.
  EXPECT_LT(z(moments_of(*in_place_scene, kAhead), moments_of(*placed_scene, moved)), 4);
  EXPECT_GT(z(moments_of(*in_place_scene, kAhead), moments_of(*placed_scene, kAhead)), 4)
      << "the placed grid must not be at its old place";
  // A grid whose own transform contains the placement gives the same values.
  SceneMaker mapped;
  lit(mapped);
  VolumeGrid grid = lumps();
  grid.to_medium = placement * grid.to_medium;
  const MediumId same = test::add(mapped, varying(kSmoke, add_grid(mapped, grid)));
  test::fill_mesh(mapped, unit_cube(), placement * translation({-1, -1, -1}) * scaling({2, 2, 2}),
                  same);
  expect_same(*placed_scene, moved, *mapped.build(), moved);
}

TEST(GridMedia, ScalingAGridKeepsItsCoefficients) {
  SceneMaker small;
  small.background(gray(1), gray(1));
  const Medium absorbs{.absorption = gray(0.3f)};
  fill_placed(small, test::add(small, varying(absorbs, add_grid(small, constant(1)))),
              scaling({1, 1, 0.25}));
  // The ray passes 2 x 0.25 units of the medium, because distances are measured in world space.
  EXPECT_NEAR(moments_of(*small.build(), kAhead).mean(), std::exp(-0.3 * 0.5), 1e-5);
}

TEST(GridMedia, EachInstanceHasTheSharedMediumInItsOwnPlace) {
  // The density is 0 in the half at -x.
  const VolumeGrid half = [] {
    VolumeGrid grid = test::grid_of({16, 8, 8}, {-1, -1, -1}, {1, 1, 1},
                                    [](auto x, auto, auto) { return x < 8 ? 0.0f : 1.0f; });
    grid.filter = VolumeGrid::Filter::kNearest;
    return grid;
  }();
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  const MediumId dark = test::add(maker, varying({.absorption = gray(1)}, add_grid(maker, half)));
  fill_placed(maker, dark, translation({-5, 0, 0}));
  fill_placed(maker, dark, translation({5, 0, 0}) * scaling({-1, 1, 1}));
  // The sphere has no frame, so its medium is in world space.
  test::fill_sphere(maker, {0, 0, 0}, 1, dark);
  const auto scene = maker.build();
  const auto seen = [&](double x) {
    return one(*scene, {.origin = {x, 0, 5}, .direction = {0, 0, -1}}, 1).g;
  };
  EXPECT_EQ(seen(-5.5), 1);
  EXPECT_NEAR(seen(-4.5), std::exp(-2), 1e-6);
  EXPECT_NEAR(seen(4.5), std::exp(-2), 1e-6);
  EXPECT_EQ(seen(5.5), 1);
  EXPECT_EQ(seen(-0.01), 1);
  EXPECT_NEAR(seen(0.01), std::exp(-2), 1e-3);
}

TEST(GridMedia, TheLastOfOverlappingBoundariesCounts) {
  VolumeGrid slope = test::grid_of({16, 8, 8}, {-1, -1, -1}, {1, 1, 1},
                                   [](auto x, auto, auto) { return static_cast<float>(x); });
  slope.filter = VolumeGrid::Filter::kNearest;
  SceneMaker maker;
  maker.background(gray(1), gray(1));
  const MediumId dark =
      test::add(maker, varying({.absorption = gray(0.1f)}, add_grid(maker, slope)));
  fill_placed(maker, dark, {});
  fill_placed(maker, dark, translation({0.5, 0, 0.5}));
  const auto scene = maker.build();
  // At x = 0.3 the density is 10 in the first box and 6 in the second. The second box reaches from
  // z = -0.5 to z = 1.5, and 0.5 units of the first box remain.
  const Moments seen = moments_of(*scene, {.origin = {0.3, 0, 5}, .direction = {0, 0, -1}});
  EXPECT_LT(std::abs(seen.z(std::exp(-0.1 * (6 * 2 + 10 * 0.5)))), 4);
}

TEST(GridMedia, AGridMovesWithItsBoundary) {
  const auto with_keys = [](std::vector<Key> keys, const Shutter& shutter) {
    SceneMaker maker;
    maker.camera({0, 0, 5}, {0, 0, 0}, 40);
    std::get<PerspectiveCamera>(maker.scene.camera).shutter = shutter;
    maker.background(gray(0.2f), gray(1));
    const MediumId smoke = test::add(maker, varying(kSmoke, add_grid(maker, lumps())));
    fill_placed(maker, smoke, {}, std::move(keys));
    return maker.build();
  };
  const auto moving = with_keys({Key(0, {}), Key(2, translation({2, 0, 0}))}, {0, 2});
  EXPECT_TRUE(moving->features().motion);
  const auto still = with_keys({Key(0, translation({1, 0, 0}))}, {0, 2});
  EXPECT_FALSE(still->features().motion);
  const Ray ray{.origin = {0.6, 0.2, 5}, .direction = {0, 0, -1}, .time = 1};
  expect_same(*moving, ray, *still, ray);
  Ray early = ray;
  early.time = 0.1;
  EXPECT_GT(z(moments_of(*moving, ray), moments_of(*moving, early)), 4);
}

TEST(GridMedia, ShadowsOfAGridFollowTheClosedForm) {
  SceneMaker maker;
  maker.quad({-4, 0, 4}, {8, 0, 0}, {0, 0, -8}, maker.diffuse(1));
  maker.scene.lights = {DirectionalLight{{0, -1, 0}, gray(1)}};
  VolumeGrid steps = test::grid_of({1, 64, 1}, {-1, 1, -1}, {1, 3, 1},
                                   [](auto, auto y, auto) { return static_cast<float>(y % 5); });
  steps.border = VolumeGrid::Border::kClamp;
  // The mean density along the ray is the sum of all numbers over their count. Interpolation at the
  // ends does not change it, because the border is clamped.
  double sum = 0;
  for (int y = 0; y < 64; ++y) {
    sum += y % 5;
  }
  const Medium dark = varying({.absorption = gray(0.5f)}, add_grid(maker, steps));
  test::fill_box(maker, {-1, 1, -1}, {1, 3, 1}, test::add(maker, dark));
  const auto scene = maker.build();
  const Ray below{.origin = {0.3, 0.5, 0.2}, .direction = {0, -1, 0}};
  const Moments seen = moments_of(*scene, below, {.max_depth = 1});
  EXPECT_LT(std::abs(seen.z(std::exp(-0.5 * 2 * sum / 64) / 3.14159265358979)), 4);
}

TEST(GridMedia, FireLightsItsSurroundings) {
  // The fire has a temperature of 2000 K, and it neither absorbs nor scatters. A homogeneous medium
  // with the same emission must look the same and must light the floor in the same way.
  SceneMaker fire;
  fire.quad({-4, -2, 4}, {8, 0, 0}, {0, 0, -8}, fire.diffuse(0.6f));
  SceneMaker glow = fire;
  Medium hot{.emission = gray(100)};
  hot.grids.temperature = GridUse{add_grid(fire, constant(1500)), 1};
  hot.grids.temperature_offset = 500;
  hot.grids.emission = GridUse{add_grid(fire, constant(1)), 1};
  test::fill_box(fire, {-1, -1, -1}, {1, 1, 1}, test::add(fire, hot));
  const Rgb color = blackbody(2000, BlackbodyScale::kPower);
  test::fill_box(glow, {-1, -1, -1}, {1, 1, 1}, test::add(glow, {.emission = color * 100}));
  const auto a = fire.build();
  const auto b = glow.build();
  for (const Ray& ray :
       {kAhead, Ray{.origin = {0, 0, 4}, .direction = normalize(Vec3{0, -1, -1})}}) {
    const Moments seen = moments_of(*a, ray);
    EXPECT_GT(seen.mean(), 0.01);
    EXPECT_LT(z(seen, moments_of(*b, ray)), 4);
  }
}

}  // namespace
}  // namespace bandsaw
