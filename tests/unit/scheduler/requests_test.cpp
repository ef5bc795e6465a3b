// Requests of users: priorities, pausing and resuming, and why a job waits.

#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

JobId submit(FarmDriver& farm, const std::string& request, std::int32_t priority) {
  return farm.send(input::Submit{test_job(request, StopAtSamples{64}, 64, 64), priority}).job;
}

/// Sends the scheduler the finished pixels of the newest lease, in the name of worker "a". Returns
/// the job of the next lease that the scheduler grants.
JobId next_leased(FarmDriver& farm) {
  const action::Lease last = farm.all<action::Lease>().back();
  farm.stored(last, "a");
  return farm.all<action::Lease>().back().job;
}

TEST(Priority, TheHigherPriorityIsLeasedFirstAndCanChange) {
  FarmDriver farm;
  const JobId old = submit(farm, "r1", 0);
  farm.hello(1, "a", 1);
  EXPECT_EQ(farm.all<action::Lease>().back().job, old);
  const JobId urgent = submit(farm, "r2", 10);
  EXPECT_EQ(next_leased(farm), urgent);
  farm.send(input::SetPriority{old, 11});
  EXPECT_EQ(next_leased(farm), old);
  farm.send(input::SetPriority{old, 10});
  EXPECT_EQ(next_leased(farm), old) << "the older of two jobs of equal priority is first";
  EXPECT_EQ(farm.job(old).priority, 10);
}

TEST(Priority, APriorityOutOfRangeOrOfAnUnknownJobIsAnError) {
  FarmDriver farm;
  const JobId job = submit(farm, "r1", 0);
  EXPECT_TRUE(absl::IsInvalidArgument(farm.send(input::SetPriority{job, 1001}).status));
  EXPECT_TRUE(absl::IsNotFound(farm.send(input::SetPriority{job + 1, 1}).status));
  farm.send(input::Cancel{job});
  EXPECT_TRUE(absl::IsFailedPrecondition(farm.send(input::SetPriority{job, 1}).status));
  EXPECT_TRUE(absl::IsFailedPrecondition(farm.send(input::Pause{job}).status));
}

TEST(Pause, RevokesLeasesThatAreNotBegunAndKeepsTheOthers) {
  FarmDriver farm;
  const JobId job = submit(farm, "r1", 0);
  farm.hello(1, "a", 2);
  const auto leases = farm.all<action::Lease>();
  ASSERT_EQ(leases.size(), 2u);
  const Step step = farm.send(input::Pause{job});
  ASSERT_EQ(in<action::Revoke>(step).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(step)[0].leases, std::vector<LeaseId>{leases[1].lease});
  EXPECT_EQ(farm.job(job).state, JobState::kPaused);
  const Step stored = farm.stored(leases[0], "a");
  EXPECT_EQ(in<action::AddToFilm>(stored).size(), 1u);
  EXPECT_TRUE(in<action::Lease>(stored).empty());
  EXPECT_FALSE(in<action::Lease>(farm.send(input::Resume{job})).empty());
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
}

TEST(Pause, RevokesUnfinishedLeasesAfterASecond) {
  FarmDriver farm;
  const JobId job = submit(farm, "r1", 0);
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  const auto leases = farm.all<action::Lease>();
  ASSERT_EQ(leases.size(), 2u);
  farm.send(input::Pause{job});
  const auto rows = leases[1].band.rows.count();
  farm.send(input::Heartbeat{2, {{leases[1].lease, rows, 0}}, "sending"});
  farm.pass_time(0.5, {1, 2});
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  farm.pass_time(1, {1, 2});
  const auto revoked = farm.all<action::Revoke>();
  ASSERT_EQ(revoked.size(), 1u) << "a lease whose band is being sent must be kept";
  EXPECT_EQ(revoked[0].leases, std::vector<LeaseId>{leases[0].lease});
  EXPECT_EQ(in<action::AddToFilm>(farm.stored(leases[1], "b")).size(), 1u);
  EXPECT_TRUE(farm.job(job).workers.empty());
}

TEST(Pause, LeavesTheWorkersToOtherJobs) {
  FarmDriver farm;
  const JobId first = submit(farm, "r1", 0);
  const JobId second = submit(farm, "r2", 0);
  farm.hello(1, "a", 2);
  const auto leases = in<action::Lease>(farm.send(input::Pause{first}));
  ASSERT_EQ(leases.size(), 1u);
  EXPECT_EQ(leases[0].job, second);
}

TEST(Pause, APauseByAUserIsNotEndedByTheDiskOrARestart) {
  FarmDriver farm;
  const JobId job = submit(farm, "r1", 7);
  farm.send(input::Pause{job});
  farm.send(input::StorageFailed{job, "the disk is full"});
  farm.send(input::StorageBack{});
  EXPECT_EQ(farm.job(job).state, JobState::kPaused);
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(next.job(job).state, JobState::kPaused);
  EXPECT_EQ(next.job(job).priority, 7);
  next.send(input::Resume{job});
  EXPECT_EQ(next.job(job).state, JobState::kRunning);
}

TEST(Pause, DoesNotCountAsTimeOfTheJob) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtTime{10, kMaxSamples}));
  farm.hello(1, "a", 1);
  farm.pass_time(4, {1});
  EXPECT_EQ(farm.job(job).elapsed_s, 4);
  farm.send(input::Pause{job});
  farm.pass_time(20, {1});
  EXPECT_EQ(farm.job(job).elapsed_s, 4);
  EXPECT_LT(farm.job(job).remaining_s, 0) << "the remaining time must be unknown in a pause";
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(next.job(job).elapsed_s, 4) << "a restart must not count the pause";
  farm.send(input::Resume{job});
  farm.pass_time(3, {1});
  EXPECT_EQ(farm.job(job).elapsed_s, 7);
  EXPECT_EQ(farm.job(job).remaining_s, 3);
}

// A pause revokes the lease only after a second. Here the job is resumed after half a second.
TEST(Pause, APauseDuringWhichTheLeaseIsKeptDoesNotCountAsTimeOfTheJob) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtTime{10, kMaxSamples}));
  farm.hello(1, "a", 1);
  farm.pass_time(4, {1});
  farm.send(input::Pause{job});
  farm.pass_time(0.5, {1});
  ASSERT_TRUE(farm.all<action::Revoke>().empty());
  farm.send(input::Resume{job});
  ASSERT_EQ(farm.all<action::Lease>().size(), 1u);
  farm.pass_time(3, {1});
  EXPECT_EQ(farm.job(job).elapsed_s, 7);
}

TEST(Why, StatesWhatAJobWaitsFor) {
  FarmDriver farm;
  const JobId urgent = submit(farm, "r1", 10);
  const JobId job = submit(farm, "r2", 0);
  EXPECT_EQ(farm.scheduler.why(job, farm.now).at(0), "no worker is connected");
  farm.hello(1, "a", 1);
  EXPECT_EQ(farm.scheduler.why(job, farm.now).at(0),
            "all workers are busy with job 1 (priority 10)");
  EXPECT_EQ(farm.job(job).reason, "all workers are busy with job 1 (priority 10)");
  EXPECT_NE(farm.scheduler.why(urgent, farm.now).at(0).find("worker-a works on it"),
            std::string::npos);
  farm.send(input::Pause{job});
  EXPECT_NE(farm.scheduler.why(job, farm.now).at(0).find("paused by a user"), std::string::npos);
  farm.send(input::Cancel{job});
  EXPECT_EQ(farm.scheduler.why(job, farm.now).at(0), "it was cancelled");
  EXPECT_TRUE(farm.scheduler.why(99, farm.now).empty());
}

TEST(Why, NamesRefusedWorkersUntilTheyStopTrying) {
  FarmDriver farm;
  const JobId job = submit(farm, "r1", 0);
  WorkerHello worker;
  worker.instance = "x";
  worker.name = "desk";
  worker.protocol = 1;
  worker.pixel_version = 2;
  worker.canary = 4;  // the hash of the worker's test render; the coordinator's is 3
  worker.build = "1a2b";
  farm.send(input::Hello{1, worker});
  EXPECT_NE(farm.scheduler.why(job, farm.now).at(0).find("desk was refused: its test render"),
            std::string::npos);
  ASSERT_EQ(farm.scheduler.workers(farm.now).size(), 1u);
  EXPECT_EQ(farm.scheduler.workers(farm.now)[0].state, "refused");
  farm.pass_time(200);  // a refusal is forgotten after 180 s
  EXPECT_TRUE(farm.scheduler.workers(farm.now).empty());
}

}  // namespace
}  // namespace bandsaw::coordinator
