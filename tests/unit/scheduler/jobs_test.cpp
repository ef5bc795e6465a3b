// Jobs from submission to their end. A job is rendered in passes. A pass is a range of samples that
// is rendered for the whole image.

#include "coordinator/scheduler/model/job.h"

#include <cmath>

#include "farm_driver.h"
#include "proto/wire/limits.h"

namespace bandsaw::coordinator {
namespace {

TEST(Jobs, OneWorkerRendersEverySampleOnceAndTheResultIsWritten) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{100}));
  farm.hello(1, "a");
  farm.render_all(1, "a");
  std::uint64_t samples = 0;
  for (const auto& added : farm.all<action::AddToFilm>()) {
    for (const RowRange& rows : added.rows) {
      samples += rows.count() * added.band.samples.samples() * 8;
    }
  }
  EXPECT_EQ(samples, 100u * 8 * 8);
  const auto written = farm.all<action::WriteResult>();
  ASSERT_EQ(written.size(), 1u);
  EXPECT_EQ(written[0].samples, 100u);
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  farm.send(input::ResultWritten{job});
  const JobView view = farm.job(job);
  EXPECT_EQ(view.state, JobState::kDone);
  EXPECT_EQ(view.fraction, 1);
  EXPECT_EQ(view.samples_done, 100u * 8 * 8);
  EXPECT_EQ(view.samples_per_pixel, 100u);
  EXPECT_EQ(view.workers_used, 1u);
  EXPECT_EQ(view.counters.rays, 100u * 8);  // stored() counts a ray for each sample of each row
  EXPECT_EQ(farm.all<action::DropBands>().size(), 1u);
}

TEST(Jobs, TheSameRequestIdIsTheSameJob) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}));
  const std::size_t records = farm.records.size();
  EXPECT_EQ(farm.submit(test_job("r1", StopAtSamples{8})), job);
  EXPECT_EQ(farm.records.size(), records);
  const Step other = farm.send(input::Submit{test_job("r1", StopAtSamples{32})});
  EXPECT_EQ(other.status.code(), absl::StatusCode::kAlreadyExists);
  EXPECT_NE(farm.submit(test_job("r2", StopAtSamples{8})), job);
}

TEST(Jobs, TooManyAreRefusedUntilOneIsOver) {
  FarmDriver farm;
  for (std::size_t i = 0; i < wire::kActiveJobs; ++i) {
    ASSERT_TRUE(
        farm.scheduler.step(input::Submit{test_job(std::to_string(i), StopAtSamples{8})}, farm.now)
            .status.ok());
  }
  const JobSpec one_more = test_job("one more", StopAtSamples{8});
  EXPECT_EQ(farm.send(input::Submit{one_more}).status.code(), absl::StatusCode::kResourceExhausted);
  farm.send(input::Cancel{7});
  EXPECT_TRUE(farm.send(input::Submit{one_more}).status.ok());
}

TEST(Jobs, CancelRevokesLeasesAndDropsTheBands) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{64}));
  farm.hello(1, "a");
  const auto leases = farm.all<action::Lease>();
  ASSERT_EQ(leases.size(), 2u);
  const Step step = farm.send(input::Cancel{job});
  ASSERT_EQ(in<action::Revoke>(step).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(step)[0].leases.size(), 2u);
  EXPECT_EQ(in<action::DropBands>(step).size(), 1u);
  EXPECT_EQ(farm.job(job).state, JobState::kCancelled);
  EXPECT_EQ(farm.scheduler.wanted(job, leases[0].band), std::nullopt);
  EXPECT_TRUE(farm.stored(leases[0], "a").actions.empty());
  EXPECT_TRUE(farm.send(input::Cancel{job}).status.ok());
  EXPECT_EQ(farm.send(input::Cancel{99}).status.code(), absl::StatusCode::kNotFound);
}

TEST(Jobs, AWorkerGoesOnToTheNextJobWhenTheFirstHasNothingFree) {
  FarmDriver farm;
  const JobId first = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  const JobId second = farm.submit(test_job("r2", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const auto leases = farm.all<action::Lease>();
  ASSERT_EQ(leases.size(), 2u);
  EXPECT_EQ(leases[0].job, first);
  EXPECT_EQ(leases[1].job, second);
}

TEST(Jobs, AFullDiskPausesAJobUntilThereIsRoom) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{64}));
  farm.send(input::StorageFailed{job, "the disk is full"});
  EXPECT_EQ(farm.job(job).state, JobState::kPaused);
  EXPECT_EQ(farm.job(job).reason, "the disk is full");
  farm.hello(1, "a");
  EXPECT_TRUE(farm.all<action::Lease>().empty());
  const Step back = farm.send(input::StorageBack{});
  EXPECT_EQ(in<action::Lease>(back).size(), 2u);
  farm.render_all(1, "a");
  farm.send(input::StorageFailed{job, "the disk is full"});
  EXPECT_EQ(farm.job(job).state, JobState::kPaused);
  EXPECT_EQ(in<action::WriteResult>(farm.send(input::StorageBack{})).size(), 1u);
}

TEST(Jobs, AnErrorTargetEndsAtTheFirstCheckpointThatReachesIt) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtError{0.01, kMaxSamples}));
  farm.hello(1, "a");
  std::vector<std::uint64_t> checkpoints;
  for (int i = 0; i < 50 && farm.job(job).state == JobState::kRunning; ++i) {
    farm.render_all(1, "a");
    const std::uint64_t n = farm.job(job).samples_per_pixel;
    checkpoints.push_back(n);
    const double error = 0.2 / std::sqrt(static_cast<double>(n));
    farm.send(input::PassMerged{job, n, ErrorEstimate{.relative_rmse = error}});
  }
  // The error is 0.2 / sqrt(n), so it reaches the target of 0.01 at 400 samples. It is compared
  // with the target only at checkpoints, and the next checkpoint has at most a quarter more
  // samples.
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  EXPECT_EQ(checkpoints.front(), 32u);
  EXPECT_GE(checkpoints.back(), 400u);
  EXPECT_LE(checkpoints.back(), 500u);
  EXPECT_EQ(farm.all<action::WriteResult>().back().samples, checkpoints.back());
  EXPECT_LE(checkpoints.size(), 8u);
}

TEST(Jobs, AnErrorTargetThatCannotBeReachedEndsAtMaxSamples) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtError{1e-9, 200}));
  farm.hello(1, "a");
  for (int i = 0; i < 50 && farm.job(job).state == JobState::kRunning; ++i) {
    farm.render_all(1, "a");
    farm.send(input::PassMerged{job, farm.job(job).samples_per_pixel,
                                ErrorEstimate{.relative_rmse = 0.5}});
  }
  EXPECT_EQ(farm.all<action::WriteResult>().back().samples, 200u);
}

TEST(Jobs, ATimeLimitEndsAtTheLastCompletePassAndRevokesTheRest) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtTime{20, kMaxSamples}));
  farm.hello(1, "a");
  std::size_t done = 0;
  while (farm.now < 1019) {  // the job began at 1000 and may take 20 s
    const auto leases = farm.all<action::Lease>();
    ASSERT_LT(done, leases.size());
    farm.stored(leases[done++], "a", 0.5);
    farm.pass_time(0.5, {1});
  }
  farm.pass_time(3, {1});
  const std::uint64_t samples = farm.job(job).samples_per_pixel;
  EXPECT_GT(samples, 0u);
  ASSERT_EQ(farm.all<action::WriteResult>().size(), 1u);
  EXPECT_EQ(farm.all<action::WriteResult>()[0].samples, samples);
  EXPECT_FALSE(farm.all<action::Revoke>().empty());
}

TEST(Jobs, ATimeLimitShorterThanTheFirstPassStillGivesAWholeImage) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtTime{1, kMaxSamples}));
  farm.hello(1, "a");
  farm.pass_time(5, {1});
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  farm.render_all(1, "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  EXPECT_GE(farm.job(job).samples_per_pixel, 8u);
}

}  // namespace
}  // namespace bandsaw::coordinator
