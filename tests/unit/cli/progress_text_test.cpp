// The text of the progress line: bar, percentage, remaining time, workers, error.

#include "coordinator/cli/progress/progress_text.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Progress some_progress() {
  Progress progress;
  JobView& job = progress.job;
  job.id = 7;
  job.spec.name = "cornell";
  job.spec.settings.width = 600;
  job.spec.settings.height = 600;
  job.spec.stop = StopAtError{.relative_rmse = 0.01};
  job.fraction = 0.624;
  job.error = 0.016;
  job.samples_done = 48'200'000;
  job.samples_per_s = 5.2e6;
  job.remaining_s = 8.3;
  job.elapsed_s = 12;
  job.workers_used = 4;
  job.workers = {{"desk", 16, 3.1e6, {320, 352}, "rendering"},
                 {"laptop", 8, 1.4e6, {352, 368}, "rendering"}};
  return progress;
}

TEST(ProgressText, TheLinesShowErrorSamplesSpeedTimeAndWorkers) {
  EXPECT_EQ(header_line(some_progress()), "job 7 · cornell · 600×600 · until error ≤ 1 %");
  EXPECT_EQ(bar_line(some_progress(), 80),
            " 62 % ━━━━━━━━━━━━╸        error 1.6 % · 48 Msamples · 5.2 M/s · 0:09 left");
  EXPECT_THAT(worker_lines(some_progress(), 9),
              ElementsAre("   desk     16 threads  3.1 M/s   rows 320–352",
                          "   laptop    8 threads  1.4 M/s   rows 352–368"));
  EXPECT_EQ(plain_line(some_progress()),
            " 62 % · error 1.6 % · 48 Msamples · 5.2 M/s · 0:09 left · 2 workers");
}

TEST(ProgressText, HalfCellsOfTheBarAreShown) {
  Progress progress = some_progress();
  progress.job.fraction = 0.63;
  EXPECT_THAT(bar_line(progress, 80), HasSubstr("━━━━━━━━━━━━╸        error"));
  progress.job.fraction = 0;
  EXPECT_THAT(bar_line(progress, 80), HasSubstr("  0 %                      error"));
  progress.job.fraction = 7;
  EXPECT_THAT(bar_line(progress, 80), HasSubstr("100 % ━━━━━━━━━━━━━━━━━━━━ error"));
}

TEST(ProgressText, ANarrowWindowHasAShorterBar) {
  const std::string line = bar_line(some_progress(), 63);
  EXPECT_EQ(line, " 62 % ━━━━━╸    error 1.6 % · 48 Msamples · 5.2 M/s · 0:09 left");
  EXPECT_EQ(bar_line(some_progress(), 10),
            " 62 %  error 1.6 % · 48 Msamples · 5.2 M/s · 0:09 left");
}

TEST(ProgressText, UnknownValuesAreNotShown) {
  Progress progress = some_progress();
  progress.job.error = -1;
  progress.job.remaining_s = -1;
  progress.job.samples_per_s = 0;
  progress.job.workers.clear();
  EXPECT_EQ(plain_line(progress), " 62 % · 48 Msamples · 0 workers");
}

TEST(ProgressText, AnUnfinishedJobNeverShowsOneHundredPercent) {
  Progress progress = some_progress();
  progress.job.fraction = 0.9999;
  EXPECT_THAT(plain_line(progress), HasSubstr(" 99 %"));
}

TEST(ProgressText, AWaitingJobShowsItsReason) {
  Progress progress = some_progress();
  progress.job.workers.clear();
  progress.job.reason = "no worker is connected";
  EXPECT_THAT(worker_lines(progress, 5), ElementsAre("   no worker is connected"));
  EXPECT_THAT(plain_line(progress), HasSubstr("· no worker is connected"));
}

TEST(ProgressText, AnIdleWorkerShowsItsState) {
  Progress progress = some_progress();
  progress.job.workers = {{"b\x1bx", 1, 0, {0, 0}, "fetching scene"}};
  EXPECT_THAT(worker_lines(progress, 5),
              ElementsAre("   b?x       1 thread             fetching scene"));
}

TEST(ProgressText, ManyWorkersAreCounted) {
  Progress progress = some_progress();
  progress.job.workers.resize(10, progress.job.workers.front());
  const auto lines = worker_lines(progress, 4);
  ASSERT_EQ(lines.size(), 4u);
  EXPECT_EQ(lines.back(), "   … and 7 more workers");
  EXPECT_EQ(worker_lines(progress, 10).size(), 10u);
}

TEST(ProgressText, TheLastLineShowsTheCost) {
  Progress progress = some_progress();
  progress.job.elapsed_s = 21.43;
  progress.job.error = 0.0099;
  EXPECT_EQ(final_line(progress, "cornell.png"), "cornell.png · error 0.99 % · 21.4 s · 4 workers");
  progress.job.error = -1;
  progress.threads = 1;
  EXPECT_EQ(final_line(progress, "cornell.png"), "cornell.png · 21.4 s · 1 thread");
}

// A clean image is a denoised image.
TEST(ProgressText, ACleanImageShowsItsOwnError) {
  Progress progress = some_progress();
  progress.job.error = 0.16;
  progress.clean_error = 0.06;
  EXPECT_THAT(plain_line(progress), HasSubstr(" 62 % · clean error 6 % · 48 Msamples"));
  EXPECT_EQ(final_line(progress, "cornell.png"),
            "cornell.png · clean error 6 % · 12.0 s · 4 workers");
}

TEST(ProgressText, TheLastLineNamesTheReports) {
  EXPECT_THAT(final_line(some_progress(), "a.png", "a.json"),
              testing::EndsWith(" · report a.json"));
}

// The cost line predicts when the error will be 1 %. In this test the error falls from 4 % to 2 %
// between 128 and 256 samples. For each further doubling of the samples, the curve of this
// doubling is repeated, each time lower by the factor 2^(-3/4), the steepest fall that is accepted.
// So the error at 512 f samples (1 < f <= 2) is 4 % / f / 2^1.5. The error is 1 % at 724 samples,
// after 11.3 s of CPU. doubt_line() is a warning if a large share of the error is in the worst
// pixels (worst_share).
TEST(ProgressText, TheCostLineShowsRaysTimesAndTheErrorsOfMostPixels) {
  Progress progress = some_progress();
  JobView& job = progress.job;
  job.samples_per_pixel = 256;
  job.counters.rays = 8'000'000;
  job.cpu_s = 4;
  job.curve = {{128, 1, 2, {.relative_rmse = 0.04}},
               {256, 2, 4, {.relative_rmse = 0.02, .median = 0.012, .percentile_95 = 0.05}}};
  EXPECT_EQ(cost_line(progress),
            "256 samples a pixel · 8 M rays, 2 M/CPU s · 4.0 s of CPU · 1 % error after 11.3 s of "
            "CPU · error up to 1.2 % in half of the pixels, up to 5 % in 95 %");
  EXPECT_THAT(doubt_line(progress), IsEmpty());
  job.curve.back().estimate.worst_share = 0.4;
  EXPECT_THAT(doubt_line(progress), HasSubstr("40 % of the error"));
  job.curve.clear();
  job.cpu_s = 0;
  EXPECT_EQ(cost_line(progress), "256 samples a pixel · 8 M rays");
}

TEST(ProgressText, CutOffPathsAndDroppedPrimitivesAreReported) {
  Progress progress = some_progress();
  EXPECT_THAT(left_out_line(progress), IsEmpty());
  progress.job.samples_done = 1000;
  progress.job.spec.settings.max_depth = 5;
  progress.job.counters.truncated_paths = 20;
  EXPECT_EQ(left_out_line(progress), "2 % of the paths were cut off at depth 5");
  progress.job.counters.dropped_primitives = 1;
  EXPECT_EQ(left_out_line(progress),
            "2 % of the paths were cut off at depth 5 · 1 primitive without area left out");
}

TEST(ProgressText, BadSamplesAreAWarning) {
  Progress progress = some_progress();
  EXPECT_THAT(bad_samples_line(progress), IsEmpty());
  progress.job.counters = {.rays = 1, .bad_samples = 3, .bad_x = 5, .bad_y = 6, .bad_sample = 9};
  progress.bad_sample_at = bad_sample_text(progress.job.counters);
  EXPECT_THAT(bad_samples_line(progress), HasSubstr("warning: 3 samples"));
  EXPECT_THAT(bad_samples_line(progress), HasSubstr("pixel (5, 6), sample 9"));
}

}  // namespace
}  // namespace bandsaw::coordinator
