// Tests that adaptive sampling is unbiased in scenes in which few paths find light. In such scenes
// the estimated noise of a pixel depends on whether the pixel has found light. The image is divided
// into tiles, and adaptive sampling plans the number of samples of each half tile (half of the
// pixels of a tile). The tests take 64 seeds and accept a bias of at most 3 standard errors. The
// hard case A5 tests adaptive sampling without a scene, with pixels whose samples are 0 or 1.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "renderlib/render/film.h"
#include "renderlib/render/render_band.h"
#include "renderlib/render/tile_schedule.h"
#include "tests/support/scenes.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::SceneMaker;

constexpr TileGrid kGrid{128, 2};  // the image has 128 x 2 pixels
constexpr std::uint64_t kSeeds = 64;

/// Returns a scene with a camera that sees a strip of the floor from above, and a small lamp over
/// one end of it. The renders below do not sample the lamp, so few paths find it.
SceneMaker strip(const Vec3& lamp, double radius) {
  SceneMaker maker;
  maker.camera({0, 2, 0}, {0, 0, 0.001}, 1);
  maker.sphere(lamp, radius, maker.lamp(100));
  return maker;
}

void add_floor(SceneMaker& maker, MaterialId material) {
  maker.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, material);
}

struct Rendered {
  double mean = 0;       ///< of all pixels, green channel
  bool planned = false;  ///< some tiles took more samples than others
};

/// Renders the scene. If `adaptive` is false, every pixel takes 256 samples. Otherwise the half
/// tiles take different numbers of samples after the first 64 samples of every pixel.
Rendered render(const Scene& scene, std::uint64_t seed, bool adaptive) {
  static const std::atomic<bool> kGoOn{false};
  Pool pool(1);
  const RenderSettings settings{.width = kGrid.width,
                                .height = kGrid.height,
                                .max_depth = 6,
                                .seed = seed,
                                .integrator = Integrator::kPathScattering};
  Film film = *Film::create(kGrid.width, kGrid.height, "", Film::Grain::kHalfTiles);
  const auto take = [&](const SampleRange& pass, const TileSamples& tiles) {
    const auto pixels =
        render_band(scene, settings, {pass, {0, kGrid.height}}, pool, kGoOn, {}, tiles);
    ASSERT_TRUE(pixels.ok() && film.add(*pixels, tiles).ok());
  };
  // The first three passes are the pilot, which takes 64 samples of every pixel. If `adaptive` is
  // true, the noise of the pilot decides how many samples each half tile takes in the later passes.
  for (const SampleRange& pass : {SampleRange{0, 16}, {16, 32}, {32, 64}}) {
    take(pass, {});
  }
  TilePlan plan{.pilot = 64, .levels = std::string(kGrid.half_tiles(), kEvenLevel)};
  if (adaptive) {
    plan = plan_tiles(kGrid, film.tile_errors(), plan.pilot);
  }
  TileSchedule schedule(kGrid, plan);
  for (const SampleRange& pass : {SampleRange{64, 128}, {128, 256}}) {
    take(pass, schedule.next(pass));
  }
  Rendered rendered;
  for (const Rgb& pixel : film.snapshot().image.pixels) {
    rendered.mean += pixel.g / static_cast<double>(kGrid.width * kGrid.height);
  }
  rendered.planned = !plan.even();
  return rendered;
}

/// Expects that the mean over all seeds is the same with and without adaptive sampling.
void expect_unbiased(const SceneMaker& maker) {
  const auto scene = maker.build();
  Moments even;
  Moments adaptive;
  std::uint64_t planned = 0;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    even.add(render(*scene, 1000 + seed, /*adaptive=*/false).mean);
    const Rendered rendered = render(*scene, seed, /*adaptive=*/true);
    adaptive.add(rendered.mean);
    planned += rendered.planned ? 1 : 0;
  }
  EXPECT_GT(planned, kSeeds / 4) << "more seeds should get a plan that is not even";
  const double error = std::hypot(even.standard_error(), adaptive.standard_error());
  EXPECT_LE(std::abs(adaptive.mean() - even.mean()), 3 * error)
      << "adaptive " << adaptive.mean() << ", even " << even.mean() << ", difference +- " << error;
  EXPECT_LE(error, 0.05 * even.mean());
}

TEST(RareLight, OfASmallLampOnAFloorIsNotBiasedByAdaptiveSampling) {
  SceneMaker maker = strip({-0.8, 0.6, 0.3}, 0.05);
  add_floor(maker, maker.diffuse(0.5f));
  expect_unbiased(maker);
}

TEST(RareLight, ThroughAGlassBallIsNotBiasedByAdaptiveSampling) {
  SceneMaker maker = strip({-0.8, 0.9, 0.9}, 0.05);
  maker.sphere({-0.8, 0.45, 0.45}, 0.2, maker.glass(1.5));
  add_floor(maker, maker.diffuse(0.5f));
  expect_unbiased(maker);
}

TEST(RareLight, InABrushedMetalIsNotBiasedByAdaptiveSampling) {
  SceneMaker maker = strip({-1.2, 1, 0.4}, 0.05);
  add_floor(maker, maker.metal(0.9f, 0.4));
  expect_unbiased(maker);
}

}  // namespace
}  // namespace bandsaw
