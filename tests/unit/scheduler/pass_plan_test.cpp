// The scheduler's pure functions: division of a job into passes, error checkpoints (sample numbers
// at which the error is compared with the target), sizes of bands, rates and the clock. A pass is a
// range of samples that is rendered for the whole image. It must be a node: an aligned range of 2^k
// blocks of 8 samples. Only the job's last block may be shorter.

#include <gtest/gtest.h>

#include <cmath>

#include "coordinator/scheduler/context/scheduler_clock.h"
#include "coordinator/scheduler/dispatch/band_chooser.h"
#include "coordinator/scheduler/model/pass_plan.h"
#include "coordinator/scheduler/model/rates.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

TEST(Passes, AreNodesThatFollowEachOtherToTheLastSample) {
  // Every number of samples below 300, and some of the larger ones.
  for (std::uint64_t samples = 1; samples < 3000; samples += samples < 300 ? 1 : 37) {
    std::uint64_t end = 0;
    // A pass of more than one block has at most a quarter of the job's blocks.
    for (const SampleRange& pass : passes_between(0, samples)) {
      EXPECT_EQ(pass.first, end);
      EXPECT_TRUE(is_node(pass)) << pass.first << " " << pass.last;
      EXPECT_TRUE(pass.blocks() <= 1 || pass.blocks() * 4 <= (samples + 7) / 8) << samples;
      end = pass.last;
    }
    EXPECT_EQ(end, samples);
  }
}

TEST(Passes, BeginSmallAndDouble) {
  const std::vector<SampleRange> expected = {{0, 8},   {8, 16},  {16, 32},
                                             {32, 64}, {64, 96}, {96, 128}};
  EXPECT_EQ(passes_between(0, 128), expected);
}

TEST(Passes, TheLargestJobHasFewPasses) { EXPECT_LE(passes_between(0, kMaxSamples).size(), 64u); }

// `fits` is the number of samples that are expected to fit into the remaining time.
TEST(Passes, EachPassOfATimedJobIsANodeOfAtMostAQuarterOfTheSamplesBefore) {
  std::uint64_t end = 0;
  for (int i = 0; i < 40; ++i) {
    const SampleRange pass = next_timed_pass(end, /*fits=*/1e12, kMaxSamples);
    EXPECT_EQ(pass.first, end);
    EXPECT_TRUE(is_node(pass));
    EXPECT_TRUE(end < 32 || pass.samples() * 4 <= end);
    end = pass.last;
  }
  EXPECT_EQ(next_timed_pass(1024, /*fits=*/100, kMaxSamples), (SampleRange{1024, 1088}));
  EXPECT_EQ(next_timed_pass(1024, /*fits=*/0, kMaxSamples), (SampleRange{1024, 1032}));
  EXPECT_EQ(next_timed_pass(64, /*fits=*/1000, 70), (SampleRange{64, 70}));
}

TEST(Checkpoints, AreFewAndTheLastIsAtMostAQuarterTooFar) {
  for (const double power : {0.5, 0.75, 1.0}) {
    for (const double target : {0.1, 0.01, 0.003}) {
      const auto error = [&](std::uint64_t n) { return std::pow(static_cast<double>(n), -power); };
      std::uint64_t samples = next_checkpoint(0, /*error=*/-1, target, kMaxSamples);
      int checkpoints = 1;
      while (error(samples) > target) {
        const std::uint64_t next = next_checkpoint(samples, error(samples), target, kMaxSamples);
        ASSERT_GT(next, samples);
        samples = next;
        ++checkpoints;
      }
      // Checkpoints begin at 32 samples and are multiples of 16.
      const double needed = std::max(32.0, std::pow(target, -1 / power));
      EXPECT_LE(static_cast<double>(samples), needed * 1.25 + 16);
      EXPECT_LE(checkpoints, 16);
    }
  }
}

TEST(Checkpoints, ContinueWithoutAnErrorAndStayBelowTheMaximum) {
  EXPECT_EQ(next_checkpoint(0, /*error=*/-1, 0.01, kMaxSamples), 32u);
  EXPECT_EQ(next_checkpoint(32, /*error=*/std::nan(""), 0.01, kMaxSamples), 64u);
  EXPECT_EQ(next_checkpoint(32, /*error=*/1, 1e-300, 100), 100u);
  EXPECT_EQ(next_checkpoint(0, /*error=*/-1, 0.01, 5), 5u);
}

/// Returns the data from which size_band computes a band for a worker. The worker renders 100 rows
/// of 8 samples a second, which is half of the speed of the farm. 1,000 rows are free, and no other
/// work is left. The target time of a band is 1 s. A row of tiles has 16 rows.
Sizing sizing() {
  static const CostMap even(2000);
  Sizing s;
  s.cost = &even;
  s.free = {{0, 8}, {10, 1010}};
  s.width = 100;
  s.work_rate = 80'000;  // 100 rows a second
  s.measured = true;
  s.farm_share = 0.5;
  s.work_left = 800'000;
  return s;
}

TEST(BandSizes, FillTheTargetTimeWhileMuchWorkIsLeft) {
  Sizing s = sizing();
  s.free.rows.first = 12;
  EXPECT_EQ(size_band(s), (Band{{0, 8}, {12, 112}}));
}

TEST(BandSizes, EndWhereARowOfTilesEndsIfTheyAreLongEnough) {
  Sizing s = sizing();
  EXPECT_EQ(size_band(s).rows, (RowRange{10, 96}));  // not 110
  s.work_left = 80'000;
  EXPECT_EQ(size_band(s).rows, (RowRange{10, 32}));  // not 35
  s.free.rows.first = 16;
  s.work_left = 800;
  EXPECT_EQ(size_band(s).rows, (RowRange{16, 28}));  // 32 would be a third longer
  s.free.rows = {16, 30};
  EXPECT_EQ(size_band(s).rows, (RowRange{16, 30}));
  s.free.rows = {16, 1010};
  s.work_rate = 40'000;
  EXPECT_EQ(size_band(s).rows, (RowRange{16, 22}));  // much shorter than a tile
}

TEST(BandSizes, ShrinkTowardTheEndDownToAMinimum) {
  Sizing s = sizing();
  s.free.rows.first = 7;
  s.work_left = 80'000;
  // 100 rows are left. The worker's share is 50 rows, and the band gets half of them.
  EXPECT_EQ(size_band(s).rows.count(), 25u);
  s.free.rows.first = 4;
  s.work_left = 800;
  EXPECT_EQ(size_band(s).rows.count(), 12u);  // an eighth of the target time
}

TEST(BandSizes, AreSmallBeforeAnythingIsMeasured) {
  Sizing s = sizing();
  s.free.rows.first = 12;
  s.measured = false;
  EXPECT_EQ(size_band(s).rows.count(), 20u);  // a fifth of the target time
}

TEST(BandSizes, ARowOfTilesThatIsTooMuchWorkIsCutByItsSamples) {
  Sizing s = sizing();
  s.free.samples = {256, 512};
  // The worker renders one block of 8 samples of a row of tiles a second. A band that is cut by its
  // samples may take up to two target times: two blocks of a row of tiles, four of half a row.
  s.work_rate = 8 * 1600;
  s.free.rows.first = 32;
  EXPECT_EQ(size_band(s), (Band{{256, 272}, {32, 48}}));
  s.free.rows.first = 40;
  EXPECT_EQ(size_band(s), (Band{{256, 288}, {40, 48}}));
}

TEST(BandSizes, ABlockOfARowOfTilesThatIsTooMuchWorkIsCutByItsRows) {
  Sizing s = sizing();
  s.free.samples = {256, 512};
  // The row of tiles has six free rows. The worker renders one block of three rows a second.
  s.work_rate = 3 * 800;
  EXPECT_EQ(size_band(s), (Band{{256, 264}, {10, 16}}));  // two target times
  s.work_rate = 2 * 800;
  EXPECT_EQ(size_band(s), (Band{{256, 264}, {10, 12}}));  // six rows would take three target times
  s.work_rate = 1;
  EXPECT_EQ(size_band(s), (Band{{256, 264}, {10, 11}}));  // at least one row
}

TEST(BandSizes, FitIntoAMessage) {
  Sizing s = sizing();
  s.width = 65536;
  s.work_rate = 1e12;
  s.work_left = 0x1p60;
  const Band band = size_band(s);
  EXPECT_LE(std::uint64_t{band.rows.count()} * s.width * 24, wire::kBandBytes);  // 3 doubles
  EXPECT_GE(band.rows.count(), 42u);  // as many as fit: 64 MiB / (65536 x 24 bytes) = 42.7
}

TEST(RecentRate, CoversTheLastTenSeconds) {
  RecentRate rate;
  rate.start(100.5);
  for (int i = 0; i < 40; ++i) {
    rate.add(100.5 + i * 0.5, 5);
  }
  EXPECT_NEAR(rate.per_second(120.4), 10, 1);
  EXPECT_EQ(rate.per_second(140), 0);
}

TEST(RecentRate, ForgetsAllAmountsWhenItIsStarted) {
  RecentRate rate;
  rate.add(100, 5);
  rate.start(120);
  EXPECT_EQ(rate.per_second(120), 0);
}

TEST(SchedulerClock, NeverGoesBackAndLimitsTheTimeoutStepOfOneInput) {
  SchedulerClock clock(/*max_timeout_step=*/1);
  clock.advance(50);
  clock.advance(50.5);
  EXPECT_EQ(clock.wall(), 50.5);
  EXPECT_EQ(clock.timeout_clock(), 0.5);
  clock.advance(40);
  EXPECT_EQ(clock.wall(), 50.5);
  clock.advance(1050.5);
  EXPECT_EQ(clock.wall(), 1050.5);
  EXPECT_EQ(clock.timeout_clock(), 1.5);
}

}  // namespace
}  // namespace bandsaw::coordinator
