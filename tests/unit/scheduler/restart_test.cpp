// Restarts of the coordinator from its journal and the bands on disk. An epoch is one run of the
// coordinator, from its start to its end.

#include "farm_driver.h"
#include "renderlib/render/work_hash.h"

namespace bandsaw::coordinator {
namespace {

/// A farm before its restart: worker "a" holds leases of a job with eight rows. `band` is the
/// result of the first lease; it may be on disk at the restart.
struct Before {
  FarmDriver farm;
  std::vector<action::Lease> leases;
  input::BandStored band;

  Before() {
    farm.submit(test_job("r1", StopAtSamples{8}));
    farm.hello(1, "a", 3);
    leases = farm.all<action::Lease>();
    band.job = 1;
    band.band = leases[0].band;
    band.row_digests = honest_digests(band.band);
  }

  /// Returns the restarted scheduler, which has replayed (read back) the records of the journal.
  /// `with_band`: `band` is on disk. The caller MUST call `replayed`, which ends the replay.
  FarmDriver restart(bool with_band = true) const {
    SchedulerOptions options = slow();
    options.epoch = "two";
    FarmDriver next(options);
    for (const Record& record : farm.records) {
      next.scheduler.replay(record);
    }
    if (with_band) {
      next.scheduler.replay(band);
    }
    return next;
  }
};

/// Returns the restarted scheduler of a farm, with these bands on disk.
FarmDriver restarted(const FarmDriver& farm, const std::vector<input::BandStored>& bands) {
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  for (const input::BandStored& band : bands) {
    next.scheduler.replay(band);
  }
  next.now = 5;  // the new process has another clock
  next.take(next.scheduler.replayed(next.now));
  return next;
}

// The pixel version is raised whenever a change of the program alters pixels. A job of an earlier
// version cannot be continued, because its old and new bands would be of different versions.
TEST(Restart, FailsJobsOfAnotherPixelVersionButNotFinalOnes) {
  FarmDriver farm;
  const JobId running = farm.submit(test_job("r1", StopAtSamples{8}));
  const JobId cancelled = farm.submit(test_job("r2", StopAtSamples{8}));
  farm.send(input::Cancel{cancelled});
  for (const std::uint32_t version : {2u, 3u}) {
    SchedulerOptions options = test_options();
    options.compatibility.pixel_version = version;
    FarmDriver next(options);
    for (const Record& record : farm.records) {
      next.scheduler.replay(record);
    }
    next.take(next.scheduler.replayed(0));
    EXPECT_EQ(next.job(cancelled).state, JobState::kCancelled);
    EXPECT_EQ(next.job(running).state, version == 2 ? JobState::kRunning : JobState::kFailed);
    if (version == 3) {
      EXPECT_EQ(next.job(running).reason,
                "begun with pixel version 2, this coordinator has 3: an image is of one version; "
                "submit it again");
      EXPECT_EQ(next.all<action::DropBands>().size(), 1u);
    }
  }
}

TEST(Restart, KeepsTheTotalsOfARunningJob) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.hello(1, "a", 1);
  input::BandStored band;
  band.job = 1;
  band.band = farm.all<action::Lease>()[0].band;
  band.row_digests = honest_digests(band.band);
  band.process = 17;
  band.cpu_s = 2.5;
  farm.send(band);
  farm.pass_time(25, {1});
  EXPECT_EQ(farm.job(1).elapsed_s, 25);
  FarmDriver next = restarted(farm, {band});
  EXPECT_EQ(next.job(1).cpu_s, 2.5);
  EXPECT_EQ(next.job(1).workers_used, 1u);
  EXPECT_NEAR(next.job(1).elapsed_s, 25, 1);
  const double before = next.job(1).elapsed_s;
  next.pass_time(7);
  next.hello(1, "b", 1);
  next.pass_time(3, {1});
  EXPECT_EQ(next.job(1).elapsed_s, before + 3) << "the time without workers is not counted";
}

TEST(Restart, KeepsTheSummaryOfAFinalJob) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.submit(test_job("r2", StopAtSamples{1000}));
  farm.hello(1, "a", 1);
  farm.render_all(1, "a");
  farm.send(input::PassMerged{1, 8, ErrorEstimate{.relative_rmse = 0.25, .worst_share = 0.5}});
  farm.send(input::ResultWritten{1});
  farm.send(input::Cancel{2});
  ASSERT_EQ(farm.job(1).curve.size(), 1u);
  ASSERT_EQ(farm.job(1).shares.size(), 1u);
  EXPECT_EQ(farm.job(1).shares[0].name, "worker-a");
  EXPECT_EQ(farm.job(1).shares[0].samples, farm.job(1).samples_done);
  const FarmDriver next = restarted(farm, {});
  for (const JobId job : {JobId{1}, JobId{2}}) {
    const JobView before = farm.job(job);
    const JobView after = next.job(job);
    EXPECT_GT(before.elapsed_s, 0);
    EXPECT_EQ(after.elapsed_s, before.elapsed_s);
    EXPECT_EQ(after.cpu_s, before.cpu_s);
    EXPECT_EQ(after.workers_used, before.workers_used);
    EXPECT_EQ(after.samples_done, before.samples_done);
    EXPECT_EQ(after.samples_per_pixel, before.samples_per_pixel);
    EXPECT_EQ(after.counters, before.counters);
    EXPECT_EQ(after.curve, before.curve);
    EXPECT_EQ(after.shares, before.shares);
  }
}

TEST(Restart, KeepsTheErrorCurveOfARunningJob) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{16}));
  const input::PassMerged merged{1, 16, ErrorEstimate{.relative_rmse = 0.25}};
  farm.send(merged);
  FarmDriver next = restarted(farm, {});
  ASSERT_EQ(next.job(1).curve, farm.job(1).curve);
  next.pass_time(5);
  EXPECT_TRUE(next.send(merged).records.empty())
      << "an error that the rebuilt film reports again must not be recorded again";
  EXPECT_EQ(next.job(1).curve, farm.job(1).curve);
}

/// Expects that both schedulers have the same jobs.
void expect_equal(const FarmDriver& one, const FarmDriver& other) {
  const std::vector<JobView> a = one.scheduler.jobs(one.now);
  const std::vector<JobView> b = other.scheduler.jobs(other.now);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].id, b[i].id);
    EXPECT_EQ(a[i].spec, b[i].spec);
    EXPECT_EQ(a[i].state, b[i].state);
    EXPECT_EQ(a[i].reason, b[i].reason);
    EXPECT_EQ(a[i].priority, b[i].priority);
    EXPECT_EQ(a[i].elapsed_s, b[i].elapsed_s);
    EXPECT_EQ(a[i].samples_done, b[i].samples_done);
    EXPECT_EQ(a[i].samples_per_pixel, b[i].samples_per_pixel);
    EXPECT_EQ(a[i].log, b[i].log);
  }
}

TEST(Snapshot, ReplaysToTheSameStateAndIsSmall) {
  FarmDriver farm;
  farm.submit(test_job("done", StopAtSamples{8}));
  farm.hello(1, "a", 1);
  farm.render_all(1, "a");
  farm.send(input::ResultWritten{1});
  farm.submit(test_job("paused", StopAtSamples{10'000}, 64, 64));
  farm.send(input::Pause{2});
  farm.send(input::SetPriority{2, -4});
  for (int i = 0; i < 50; ++i) {
    farm.send(input::SetPriority{2, i});
  }
  farm.submit(test_job("running", StopAtError{.relative_rmse = 0.01}));
  FarmDriver by_journal = restarted(farm, {});
  FarmDriver by_snapshot;
  const std::vector<Record> snapshot = farm.scheduler.snapshot();
  for (const Record& record : snapshot) {
    by_snapshot.scheduler.replay(record);
  }
  by_snapshot.now = by_journal.now;
  by_snapshot.take(by_snapshot.scheduler.replayed(by_snapshot.now));
  expect_equal(by_journal, by_snapshot);
  EXPECT_LT(2 * snapshot.size(), farm.records.size());
}

TEST(Snapshot, DropsForgottenJobsAndNeverReusesTheirIds) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.submit(test_job("r2", StopAtSamples{8}));
  farm.send(input::Cancel{2});
  const Step step = farm.send(input::Forget{{1, 2, 99}});
  ASSERT_EQ(in<action::DropJob>(step).size(), 1u) << "job 1 runs, and job 99 is not known";
  EXPECT_EQ(in<action::DropJob>(step)[0].job, 2u);
  EXPECT_FALSE(farm.scheduler.job(2, farm.now).has_value());
  FarmDriver next;
  for (const Record& record : farm.scheduler.snapshot()) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(next.submit(test_job("r2", StopAtSamples{8})), 3u);
}

TEST(Restart, LeasesNothingBeforeTheFormerWorkersReconnect) {
  const Before before;
  FarmDriver next = before.restart(/*with_band=*/false);
  next.take(next.scheduler.replayed(next.now));
  next.hello(1, "b");
  EXPECT_TRUE(next.all<action::Lease>().empty());
  EXPECT_NE(next.job(1).reason.find("waits for 1 workers"), std::string::npos);
  next.hello(2, "a");
  EXPECT_FALSE(next.all<action::Lease>().empty());
}

TEST(Restart, LeasesAfterTheGraceTimeIfFormerWorkersStayAway) {
  const Before before;
  FarmDriver next = before.restart(/*with_band=*/false);
  next.take(next.scheduler.replayed(next.now));
  next.hello(1, "b");
  next.pass_time(5, {1});
  EXPECT_TRUE(next.all<action::Lease>().empty());
  next.pass_time(2, {1});
  EXPECT_FALSE(next.all<action::Lease>().empty());
  const auto left = next.all_records<record::WorkerLeft>();
  ASSERT_EQ(left.size(), 1u);
  EXPECT_EQ(left[0].instance, "a");
}

TEST(Restart, DoesNotLeaseStoredRows) {
  const Before before;
  FarmDriver next = before.restart();
  next.take(next.scheduler.replayed(next.now));
  next.hello(1, "a");
  next.render_all(1, "a");
  for (const auto& lease : next.all<action::Lease>()) {
    EXPECT_GE(lease.band.rows.first, before.band.band.rows.last);
  }
}

// The worker still holds a lease of the run before the restart. The new run adopts this lease: it
// grants the lease again, with the same id.
TEST(Restart, AdoptsAHeldLeaseUnderItsId) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.hello(1, "a", 1);
  const action::Lease lease = farm.all<action::Lease>()[0];
  SchedulerOptions options = slow();
  options.epoch = "two";
  FarmDriver next(options);
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  const Step step = next.hello(
      7, "a", 1,
      {{.job = 1, .band = lease.band, .lease = lease.lease, .epoch = "one", .finished = false}});
  ASSERT_FALSE(in<action::Lease>(step).empty());
  EXPECT_EQ(in<action::Lease>(step)[0].lease, lease.lease);
  EXPECT_EQ(in<action::Lease>(step)[0].band, lease.band);
  EXPECT_TRUE(in<action::Revoke>(step).empty());
}

// The data folder was reset or restored, so the worker's lease is of another job with this id. The
// jobs differ in the hash of the scene and settings (work_hash).
TEST(Restart, RevokesAHeldLeaseOfAnotherJobWithTheSameId) {
  FarmDriver farm(slow());
  JobSpec spec = test_job("r1", StopAtSamples{8});
  farm.submit(spec);
  const Band band{{0, 8}, {0, 1}};
  const std::uint64_t right = work_hash(spec.manifest, spec.settings);
  spec.settings.seed += 1;
  const std::uint64_t wrong = work_hash(spec.manifest, spec.settings);
  const Step refused = farm.hello(
      1, "a", 1,
      {{.job = 1, .band = band, .lease = 77, .epoch = "old", .finished = true, .work = wrong}});
  ASSERT_EQ(in<action::Revoke>(refused).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(refused)[0].leases, std::vector<LeaseId>{77});
  FarmDriver other(slow());
  other.submit(test_job("r1", StopAtSamples{8}));
  const Step taken = other.hello(
      1, "a", 1,
      {{.job = 1, .band = band, .lease = 77, .epoch = "old", .finished = true, .work = right}});
  EXPECT_TRUE(in<action::Revoke>(taken).empty());
}

// Worker "a" holds two leases: one of a band that is on disk already, and one of an unknown job 9.
TEST(Restart, RevokesAHeldLeaseThatIsNotWanted) {
  const Before before;
  FarmDriver next = before.restart();
  next.take(next.scheduler.replayed(next.now));
  const Step step =
      next.hello(7, "a", 1,
                 {{1, before.leases[0].band, before.leases[0].lease, "one", /*finished=*/true},
                  {9, {}, 5, "one", /*finished=*/false}});
  ASSERT_EQ(in<action::Revoke>(step).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(step)[0].leases.size(), 2u);
}

TEST(Restart, FinishesACompleteJobAgain) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>()[0];
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  next.scheduler.replay(input::BandStored{.job = 1,
                                          .band = lease.band,
                                          .row_digests = honest_digests(lease.band),
                                          .instance = {},
                                          .counters = {}});
  const Step step = next.scheduler.replayed(next.now);
  ASSERT_EQ(in<action::WriteResult>(step).size(), 1u);
  EXPECT_EQ(in<action::WriteResult>(step)[0].samples, 8u);
}

TEST(Restart, RendersTheMissingBandsOfAFinishingJob) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  farm.stored(farm.all<action::Lease>()[0], "a");
  ASSERT_EQ(farm.job(1).state, JobState::kFinishing);
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(next.job(1).state, JobState::kRunning);
  next.hello(1, "a");
  EXPECT_EQ(next.all<action::Lease>().size(), 1u);
}

TEST(Reconnect, FreesLeasesThatTheWorkerDoesNotName) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 8);
  farm.render_all(2, "b");
  EXPECT_EQ(farm.job(1).state, JobState::kRunning);
  const Step step = farm.hello(3, "a", 1);
  ASSERT_EQ(in<action::Lease>(step).size(), 1u);
  farm.render_all(3, "a");
  farm.render_all(2, "b");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

TEST(Reconnect, PrefersAFinishedBandToOneThatAnotherHasBegun) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  const action::Lease lease = farm.all<action::Lease>()[0];
  farm.hello(2, "b", 1);
  farm.send(input::SessionEnded{1, "connection reset"});
  ASSERT_EQ(farm.all<action::Lease>().back().session, 2u);
  const Step step = farm.hello(3, "a", 1, {{1, lease.band, lease.lease, "one", true}});
  ASSERT_EQ(in<action::Revoke>(step).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(step)[0].session, 2u);
  EXPECT_EQ(in<action::Lease>(step)[0].session, 3u);
  farm.stored(lease, "a");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

/// Returns a band on disk that this process rendered. `lie` changes the digests.
input::BandStored on_disk(const RowRange& rows, std::uint64_t process, std::uint64_t lie = 0) {
  input::BandStored band;
  band.job = 1;
  band.band = {{0, 8}, rows};
  band.row_digests = honest_digests(band.band);
  for (std::uint64_t& digest : band.row_digests) {
    digest += lie;
  }
  band.process = process;
  return band;
}

TEST(Restart, RetractsTheRowsOfAWrongMachineOnceAllBandsAreReplayed) {
  FarmDriver farm(slow());
  farm.submit(test_job("r1", StopAtSamples{8}));
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  // Processes 2 and 3 contradict process 1. Each later band has a row that the bands before it do
  // not have.
  next.scheduler.replay(on_disk({0, 2}, 1, 99));
  next.scheduler.replay(on_disk({0, 3}, 2));
  next.scheduler.replay(on_disk({0, 4}, 3));
  EXPECT_TRUE(next.scheduler.wanted(1, {{0, 8}, {0, 4}})->empty())
      << "the film has rows of process 1 and cannot take rows of another process yet";
  next.take(next.scheduler.replayed(next.now));
  const auto retracted = next.all<action::Retract>();
  ASSERT_EQ(retracted.size(), 1u);
  EXPECT_EQ(retracted[0].process, 1u);
  EXPECT_EQ(next.scheduler.wanted(1, {{0, 8}, {0, 4}}), (std::vector<RowRange>{{0, 2}}));
}

}  // namespace
}  // namespace bandsaw::coordinator
