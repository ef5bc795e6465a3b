// Adaptive jobs give more samples to noisy parts of the image. The first samples of a job are the
// pilot, which has the same number of samples for every pixel. A half tile is half of the pixels of
// a square of 16 x 16. The errors of the pilot decide how many samples each half tile gets. These
// numbers are the tile plan. The plan is written to the journal, and every later pass follows it.

#include <cmath>

#include "farm_driver.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {
namespace {

constexpr TileGrid kGrid{512, 32};

/// The left half of the image has eight times the error of the right half: 64 times the variance.
std::vector<HalfTileErrors> uneven() {
  std::vector<HalfTileErrors> tiles;
  for (std::uint32_t tile = 0; tile < kGrid.columns() * kGrid.rows(); ++tile) {
    const double variance = tile % kGrid.columns() < kGrid.columns() / 2 ? 1 : 1.0 / 64;
    const TileError error{/*pixels=*/64, variance, /*relative=*/variance};
    tiles.insert(tiles.end(), 2, {error, error});
  }
  return tiles;
}

/// A job with the error target 1 %, which one worker renders to its end. After each pass, the test
/// reports the error 0.2 / sqrt(samples) for the image and the errors `tiles` for the half tiles.
struct Adaptive {
  FarmDriver farm;
  JobId job = 0;
  std::vector<std::uint64_t> looks;  ///< samples at which the error was measured

  explicit Adaptive(bool adaptive = true, std::vector<HalfTileErrors> tiles = uneven()) {
    job = farm.submit(
        test_job("r1", StopAtError{0.01, kMaxSamples, adaptive}, kGrid.width, kGrid.height));
    farm.hello(1, "a");
    for (int i = 0; i < 50 && farm.job(job).state == JobState::kRunning; ++i) {
      farm.render_all(1, "a");
      looks.push_back(farm.all_records<record::PassPlanned>().back().samples.last);
      const double error = 0.2 / std::sqrt(static_cast<double>(looks.back()));
      farm.send(input::PassMerged{job, looks.back(), ErrorEstimate{.relative_rmse = error}, tiles});
    }
  }
};

TEST(Adaptive, PassesAfterThePilotFollowTheTilePlan) {
  const Adaptive run;
  EXPECT_EQ(run.farm.job(run.job).state, JobState::kFinishing);
  const auto planned = run.farm.all_records<record::TilesPlanned>();
  ASSERT_EQ(planned.size(), 1u);
  // Tiles are planned as soon as the error is at most four times the target. 0.2 / sqrt(n) <= 4 x
  // 0.01 from 25 samples on, so they are planned at the first checkpoint, 32 samples.
  EXPECT_EQ(planned[0].plan, plan_tiles(kGrid, uneven(), 32));
  TileSchedule schedule(kGrid, planned[0].plan);
  std::map<SampleRange, TileSamples> tiles_of;
  for (const auto& pass : run.farm.all_records<record::PassPlanned>()) {
    tiles_of[pass.samples] = pass.samples.first < 32 ? TileSamples() : schedule.next(pass.samples);
  }
  std::uint64_t left_out = 0;
  for (const action::Lease& lease : run.farm.all<action::Lease>()) {
    const auto pass = std::prev(tiles_of.upper_bound({lease.band.samples.first, kMaxSamples}));
    EXPECT_EQ(lease.tiles, pass->second.of(pass->first, lease.band));
    left_out += lease.tiles.whole() ? 0 : 1;
  }
  EXPECT_GT(left_out, 0u);
  // Half of the pixels have sqrt(2) times as many samples as in a uniform job. The other half has
  // an eighth of these samples, so the mean is sqrt(2) x 9 / 16.
  const JobView view = run.farm.job(run.job);
  const auto all = static_cast<double>(run.looks.back());
  EXPECT_NEAR(static_cast<double>(view.samples_per_pixel), all * std::sqrt(2) * 9 / 16, all * 0.05);
  EXPECT_EQ(view.samples_done / (kGrid.width * kGrid.height), view.samples_per_pixel);
}

TEST(Adaptive, ARestartHasTheSamePlanFromJournalAndSnapshot) {
  const Adaptive run;
  Scheduler second(test_options());
  for (const Record& record : run.farm.records) {
    second.replay(record);
  }
  Scheduler third(test_options());
  for (const Record& record : second.snapshot()) {
    third.replay(record);
  }
  for (const action::Lease& lease : run.farm.all<action::Lease>()) {
    EXPECT_EQ(second.tiles(run.job, lease.band), lease.tiles);
    EXPECT_EQ(third.tiles(run.job, lease.band), lease.tiles);
  }
}

TEST(Adaptive, PlansNoTilesForUniformJobs) {
  const Adaptive run(/*adaptive=*/false);
  EXPECT_TRUE(run.farm.all_records<record::TilesPlanned>().empty());
  EXPECT_EQ(run.farm.job(run.job).samples_per_pixel, run.looks.back());
}

TEST(Adaptive, UniformNoiseRendersAsAUniformJob) {
  const Adaptive run(true, std::vector<HalfTileErrors>(kGrid.half_tiles(),
                                                       {TileError{64, 1, 1}, TileError{64, 1, 1}}));
  EXPECT_EQ(run.farm.all_records<record::TilesPlanned>().size(), 1u);
  for (const action::Lease& lease : run.farm.all<action::Lease>()) {
    EXPECT_TRUE(lease.tiles.whole());
  }
  EXPECT_EQ(run.farm.job(run.job).samples_per_pixel, run.looks.back());
  EXPECT_EQ(run.looks, Adaptive(/*adaptive=*/false).looks);
}

}  // namespace
}  // namespace bandsaw::coordinator
