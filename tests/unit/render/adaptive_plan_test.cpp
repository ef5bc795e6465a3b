// The plan of adaptive sampling. It says how many samples each half tile gets, by the noise that
// was measured in the pilot, the first samples of all pixels. The image must not be biased. A tile
// of 16 x 16 pixels has two half tiles, and each half tile is planned by the noise of the other
// one. TilePlan::levels has a digit l (0 to f) for each half tile. A half tile with the digit l
// gets 2^((6 - l) / 2) times the samples of uniform sampling. TilePlan::even() is true if every
// half tile gets the samples of uniform sampling. A half tile consists of groups of pixels that
// share paths. It has two TileErrors: one of its groups with even numbers, and one of its groups
// with odd numbers. An id such as A5 in a test's name is that of a case in
// tests/hard_cases/cases.txt.

#include "renderlib/render/adaptive_plan.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "renderlib/render/film.h"
#include "renderlib/render/tile_schedule.h"
#include "tests/support/hard_case.h"
#include "tests/support/random.h"
#include "tests/support/statistics.h"

namespace bandsaw {
namespace {

using test::Moments;
using test::Random;

constexpr TileGrid kGrid{64, 32};

/// Returns the errors of all half tiles. All errors in a column of tiles are `variance(column)`.
std::vector<HalfTileErrors> errors(const TileGrid& grid,
                                   const std::function<double(std::uint32_t column)>& variance) {
  std::vector<HalfTileErrors> tiles;
  for (std::uint32_t row = 0; row < grid.rows(); ++row) {
    for (std::uint32_t column = 0; column < grid.columns(); ++column) {
      const TileError error{/*pixels=*/64, variance(column), /*relative=*/variance(column)};
      tiles.insert(tiles.end(), 2, {error, error});
    }
  }
  return tiles;
}

TEST(AdaptivePlan, UniformNoiseGivesUniformPasses) {
  for (const double variance : {0.0, 1e-300, 0.3, 1e100}) {
    const TilePlan plan = plan_tiles(kGrid, errors(kGrid, [&](auto) { return variance; }), 64);
    EXPECT_TRUE(plan.even()) << variance;
    TileSchedule schedule(kGrid, plan);
    EXPECT_TRUE(schedule.next({64, 128}).whole());
    EXPECT_TRUE(schedule.next({128, 256}).whole());
  }
}

TEST(AdaptivePlan, SamplesAreProportionalToTheStandardDeviation) {
  // The variance is 1 in the left 16 columns and 1/64 in the right 16 columns. So the standard
  // deviation in the right columns is an eighth, and they get an eighth of the samples.
  const TileGrid grid{512, 32};
  const auto tiles = errors(grid, [](std::uint32_t column) { return column < 16 ? 1 : 1.0 / 64; });
  const TilePlan plan = plan_tiles(grid, tiles, 64);
  EXPECT_EQ(plan.pilot, 64u);
  // The root of the mean variance is sqrt((1 + 1/64) / 2), about 0.71. The standard deviation 1 is
  // 1.40 times that, so the nearest level is 5: 2^(1/2) times the samples of uniform sampling. The
  // level b (11) has 2^(-5/2) times the samples, an eighth of the samples of level 5.
  EXPECT_EQ(plan.levels[0], '5');
  EXPECT_EQ(plan.levels[2 * 31], 'b');
  EXPECT_NEAR(share_of(plan, 2 * 31) / share_of(plan, 0), 0.125, 1e-12);
}

TEST(AdaptivePlan, AHalfIsNotPlannedByItsOwnSamples) {
  const TileGrid grid{320, 48};
  Random random(5);
  std::vector<HalfTileErrors> tiles =
      errors(grid, [](std::uint32_t column) { return column < 8 ? 1 : 1.0 / 64; });
  const TilePlan before = plan_tiles(grid, tiles, 64);
  for (std::size_t i = 0; i < tiles.size(); i += 2) {
    for (TileError& part : tiles[i]) {
      part.variance *= random.uniform(0.001, 1000);
      part.relative *= random.uniform(0.001, 1000);
    }
  }
  const TilePlan after = plan_tiles(grid, tiles, 64);
  EXPECT_FALSE(before.even());
  for (std::size_t i = 0; i < tiles.size(); i += 2) {
    EXPECT_EQ(after.levels[i], before.levels[i]);
  }
  EXPECT_NE(after.levels, before.levels);
}

TEST(AdaptivePlan, NoiseOfOneTileIsPlannedIfEvenAndOddGroupsShowIt) {
  const TileGrid grid{512, 128};
  const auto plan_of_groups = [&](double even_groups, double odd_groups) {
    std::vector<HalfTileErrors> tiles = errors(grid, [](auto) { return 1e-3; });
    const std::size_t tile = 2 * (std::size_t{4} * grid.columns() + 7);
    for (const std::size_t half : {0, 1}) {
      tiles[tile + half] = {TileError{64, even_groups, even_groups},
                            TileError{64, odd_groups, odd_groups}};
    }
    return plan_tiles(grid, tiles, 64);
  };
  EXPECT_FALSE(plan_of_groups(1, 1).even());
  EXPECT_TRUE(plan_of_groups(1, 1e-3).even())
      << "noise in even groups alone must not change the plan";
}

TEST(AdaptivePlan, ImagesOfOneTileOrOnePixelHaveAPlan) {
  for (const TileGrid grid : {TileGrid{1, 1}, {1, 40}, {16, 16}, {17, 1}}) {
    std::vector<HalfTileErrors> tiles(grid.half_tiles(), {TileError{1, 0.5, 0.5}, TileError{}});
    tiles.back() = {};
    EXPECT_TRUE(plan_tiles(grid, tiles, 32).even());
  }
}

// Bias of adaptive sampling: hard cases A5 and A4.

/// Tiles of two rows, so that few pixels (16 in a half tile) determine the plan and each of them
/// counts.
constexpr TileGrid kThin{256, 2};
/// Draws a sample of a pixel in the left half of the image, with the expected value 1. The right
/// half is black.
using Pixel = std::function<double(Random&)>;

struct Rendered {
  double mean = 0;       ///< mean of the left half
  bool planned = false;  ///< some half tiles take more samples than others
};

/// Renders an image adaptively with samples drawn by `pixel`. If `naive` is true, each half tile is
/// planned by its own samples. If not, it is planned by the samples of the other half of its tile.
Rendered render_pixel(const Pixel& pixel, std::uint64_t seed, bool naive) {
  Random random(seed);
  Film film = *Film::create(kThin.width, kThin.height, "", Film::Grain::kHalfTiles);
  const auto take = [&](const SampleRange& pass, const TileSamples& tiles) {
    BandPixels band{
        .band = {pass, {0, kThin.height}}, .width = kThin.width, .sums = {}, .counters = {}};
    for (std::uint32_t y = 0; y < kThin.height; ++y) {
      for (std::uint32_t x = 0; x < kThin.width; ++x) {
        double sum = 0;
        const std::uint64_t samples = tiles.of_pixel(x, y, pass).samples();
        for (std::uint64_t i = 0; i < samples && x < kThin.width / 2; ++i) {
          sum += pixel(random);
        }
        band.sums.insert(band.sums.end(), 3, sum);
      }
    }
    ASSERT_TRUE(film.add(band, tiles).ok());
  };
  for (const SampleRange& pass : {SampleRange{0, 16}, {16, 32}, {32, 64}}) {
    take(pass, {});
  }
  std::vector<HalfTileErrors> tiles = film.tile_errors();
  for (std::size_t i = 0; i < tiles.size() && naive; i += 2) {
    std::swap(tiles[i], tiles[i + 1]);
  }
  const TilePlan plan = plan_tiles(kThin, tiles, 64);
  TileSchedule schedule(kThin, plan);
  for (const SampleRange& pass : {SampleRange{64, 128}, {128, 256}, {256, 384}, {384, 512}}) {
    take(pass, schedule.next(pass));
  }
  Moments mean;
  const Image image = film.snapshot().image;
  for (std::uint32_t y = 0; y < kThin.height; ++y) {
    for (std::uint32_t x = 0; x < kThin.width / 2; ++x) {
      mean.add(image.at(x, y).r);
    }
  }
  return {mean.mean(), !plan.even()};
}

/// Returns a pixel whose samples are `base` with the probability 1 - p. With the probability p a
/// sample is larger, base + (1 - base) / p, so the mean is 1.
Pixel bernoulli(double p, double base = 0) {
  return [=](Random& random) { return base + (random.uniform() < p ? (1 - base) / p : 0); };
}

constexpr int kRuns = 512;

/// The results of several renders with different seeds.
struct Result {
  Moments mean;     ///< moments of Rendered::mean
  int planned = 0;  ///< number of renders with Rendered::planned
};

/// Calls render_pixel() with `runs` different seeds.
Result renders(const Pixel& pixel, int runs, bool naive = false) {
  Result result;
  for (int i = 0; i < runs; ++i) {
    const Rendered run = render_pixel(pixel, 1000 + static_cast<std::uint64_t>(i), naive);
    result.mean.add(run.mean);
    result.planned += run.planned ? 1 : 0;
  }
  return result;
}

TEST(AdaptivePlan, A5_RareLightIsNotBiased) {
  test::Worst worst;
  for (const double base : {0.0, 0.5, 0.99}) {
    for (const double p : {0.1, 0.01, 0.001, 0.0002}) {
      const Result result = renders(bernoulli(p, base), kRuns);
      EXPECT_GT(result.planned, kRuns / 8) << "adaptive sampling must be on in enough renders";
      worst.see(std::abs(result.mean.z(1)));
    }
  }
  test::at_most("A5", "bias of the mean, in standard errors", worst.value(), 3);
}

// If each half tile were planned by its own samples, the mean would be too small, and the test
// A5_RareLightIsNotBiased would fail.
TEST(AdaptivePlan, A5_PlanningByOwnSamplesIsBiased) {
  const Result result = renders(bernoulli(0.0002), kRuns, /*naive=*/true);
  EXPECT_LT(result.mean.z(1), -4);
  EXPECT_LT(result.mean.mean(), 0.98);
}

TEST(AdaptivePlan, A4_AConstantSceneIsExact) {
  const Rendered rendered = render_pixel([](Random&) { return 1.0; }, /*seed=*/1, /*naive=*/false);
  test::at_most("A4", "error of the mean", std::abs(rendered.mean - 1), 1e-12);
  EXPECT_FALSE(rendered.planned);
}

}  // namespace
}  // namespace bandsaw
