// Tests a render on this machine, without a coordinator. LocalPlan gives the passes of the render
// (ranges of samples), one after the other, until the stop rule holds. LocalMeter measures the
// progress. The arguments of LocalPlan::next() are the number of samples per pixel that are done,
// the estimated error (-1: unknown), and the seconds so far.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "coordinator/cli/render/local_meter.h"
#include "coordinator/cli/render/local_plan.h"

namespace bandsaw::coordinator {
namespace {

// The samples of a pixel are added up in a binary tree. Each pass is a node of this tree: an
// aligned range of 2^n blocks. A block has 8 samples, but the last block may be shorter.
TEST(LocalPlan, CoversTheSamplesOnceInOrder) {
  for (const std::uint64_t samples : {1U, 16U, 17U, 64U, 72U, 1000U}) {
    LocalPlan plan(StopAtSamples{samples});
    std::uint64_t done = 0;
    while (const auto pass = plan.next(done, -1, 1)) {
      EXPECT_EQ(pass->first, done);
      EXPECT_TRUE(is_node(*pass)) << pass->first << ":" << pass->last;
      done = pass->last;
    }
    EXPECT_EQ(done, samples);
  }
}

// The error is 10 % at 32 samples. It falls as 1 / sqrt(samples), so it is 1 % at 3,200 samples.
TEST(LocalPlan, AnErrorRuleEndsWhereTheErrorIsReached) {
  LocalPlan plan(StopAtError{.relative_rmse = 0.01});
  std::uint64_t done = 0;
  double error = -1;
  while (const auto pass = plan.next(done, error, 1)) {
    ASSERT_EQ(pass->first, done);
    ASSERT_LT(done, 1U << 20);
    done = pass->last;
    error = done >= 32 ? 0.1 * std::sqrt(32.0 / static_cast<double>(done)) : -1;
  }
  EXPECT_LE(error, 0.01);
  EXPECT_GE(done, 3200u);
  EXPECT_LE(done, 2 * 3200u);
}

TEST(LocalPlan, AnErrorRuleEndsAtItsMaximumOfSamples) {
  LocalPlan plan(StopAtError{.relative_rmse = 0.01, .max_samples = 100});
  std::uint64_t done = 0;
  while (const auto pass = plan.next(done, 0.5, 1)) {
    done = pass->last;
  }
  EXPECT_EQ(done, 100u);
}

TEST(LocalPlan, ATimeRuleEndsBeforeTheTimeIsOver) {
  LocalPlan plan(StopAtTime{.seconds = 10});
  constexpr double kSamplesPerSecond = 100;
  std::uint64_t done = 0;
  while (const auto pass = plan.next(done, -1, static_cast<double>(done) / kSamplesPerSecond)) {
    ASSERT_EQ(pass->first, done);
    done = pass->last;
  }
  EXPECT_LE(done, 1000u);
  EXPECT_GT(done, 900u);
}

TEST(LocalPlan, ATimeRuleGivesAtLeastOneBlock) {
  LocalPlan plan(StopAtTime{.seconds = 0.1});
  const auto first = plan.next(0, -1, 0);
  ASSERT_TRUE(first.has_value());
  EXPECT_EQ(first->samples(), kBlockSamples);
  EXPECT_FALSE(plan.next(16, -1, 5).has_value());
}

// Each of the 50 pixels in 5 rows takes 64 samples. After 2 s, 1,600 of these 3,200 samples are
// done.
TEST(LocalMeter, ReportsTheProgressOfARender) {
  JobSpec spec;
  spec.settings = {.width = 10, .height = 10, .max_depth = 1, .seed = 0};
  spec.stop = StopAtSamples{64};
  LocalMeter meter(spec, {0, 5}, /*threads=*/2, {.steady_s = 100, .cpu_s = 7});
  meter.reached(1600);
  meter.reached(800);  // lower than before, so it is ignored
  meter.passed(32, ErrorEstimate{.relative_rmse = 0.5}, {.steady_s = 101, .cpu_s = 9});
  const Progress progress = meter.progress({.steady_s = 102, .cpu_s = 11});
  EXPECT_EQ(progress.threads, 2);
  EXPECT_EQ(progress.job.samples_done, 1600u);
  EXPECT_DOUBLE_EQ(progress.job.fraction, 0.5);
  EXPECT_DOUBLE_EQ(progress.job.elapsed_s, 2);
  EXPECT_DOUBLE_EQ(progress.job.remaining_s, 2);
  EXPECT_DOUBLE_EQ(progress.job.samples_per_s, 800);
  EXPECT_DOUBLE_EQ(progress.job.cpu_s, 4);
  EXPECT_EQ(progress.job.error, 0.5);
  ASSERT_EQ(progress.job.curve.size(), 1u);
  EXPECT_EQ(progress.job.curve[0].samples, 32u);
  EXPECT_DOUBLE_EQ(progress.job.curve[0].elapsed_s, 1);
  EXPECT_DOUBLE_EQ(progress.job.curve[0].cpu_s, 2);
  EXPECT_EQ(progress.clean_error, -1);
  meter.measured(32, 0.25);  // the error of the denoised image
  EXPECT_EQ(meter.progress({.steady_s = 102, .cpu_s = 11}).clean_error, 0.25);
  EXPECT_EQ(meter.progress({.steady_s = 102, .cpu_s = 11}).job.error, 0.5);
}

}  // namespace
}  // namespace bandsaw::coordinator
