// Workers that are lost, freeze, reconnect or fail, and bands that crash them.

#include "coordinator/scheduler/liveness/crash_attribution.h"
#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

TEST(Liveness, LeasesTheBandOfALostWorkerToAnother) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  ASSERT_EQ(first.size(), 1u);
  farm.hello(2, "b");
  const Step step = farm.send(input::SessionEnded{1, "connection reset"});
  const auto again = in<action::Lease>(step);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].session, 2u);
  EXPECT_EQ(again[0].band, first[0].band);
  EXPECT_EQ(again[0].attempt, 2u);
  farm.stored(again[0], "b");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

TEST(Liveness, ALateResultCountsAndRevokesTheSecondAttempt) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  farm.hello(2, "b");
  farm.send(input::SessionEnded{1, "connection reset"});
  const Step late = farm.stored(first[0], "a");
  ASSERT_EQ(in<action::Revoke>(late).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(late)[0].session, 2u);
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

TEST(Liveness, DisconnectsASilentWorkerAndLeasesItsBandAgain) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  farm.hello(2, "b");
  farm.pass_time(6, {2});  // session 1 is silent for more than 4 s
  EXPECT_EQ(farm.all<action::Close>().size(), 1u);
  EXPECT_EQ(farm.all<action::Lease>().back().session, 2u);
}

TEST(Liveness, AJumpOfTheClockDisconnectsNobody) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  farm.now += 1e6;
  farm.send(input::Tick{});
  farm.now -= 2e6;
  farm.send(input::Tick{});
  EXPECT_TRUE(farm.all<action::Close>().empty());
}

// A lease is revoked after 30 s without progress. A worker that prepares the scene reports a number
// that grows. In this test the number grows from 0 to 17, which counts as progress.
TEST(Liveness, RevokesALeaseWithoutProgress) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  farm.pass_time(20, {1});
  const LeaseId id = farm.all<action::Lease>()[0].lease;
  farm.send(input::Heartbeat{1, {{id, 0, 17}}, "fetching scene"});
  farm.pass_time(20, {1});
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  farm.pass_time(20, {1});
  EXPECT_FALSE(farm.all<action::Revoke>().empty());
}

// A finished band may be uploading over a slow line, but for 600 s at most.
TEST(Liveness, AnUploadHasALongerTimeout) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>()[0];
  farm.send(input::Heartbeat{1, {{lease.lease, lease.band.rows.count(), 0}}, "sending"});
  farm.pass_time(300, {1});
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  farm.pass_time(600, {1});
  EXPECT_FALSE(farm.all<action::Revoke>().empty());
}

TEST(Liveness, AReconnectKeepsTheLease) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 2));
  farm.hello(1, "a");
  const auto leases = farm.all<action::Lease>();
  const action::Lease lease = leases[0];
  const Step step = farm.hello(
      2, "a", 2, {{lease.job, lease.band, lease.lease, /*epoch=*/"one", /*finished=*/false}});
  ASSERT_EQ(in<action::Close>(step).size(), 1u);
  EXPECT_EQ(in<action::Close>(step)[0].session, 1u);
  ASSERT_FALSE(in<action::Lease>(step).empty());
  EXPECT_EQ(in<action::Lease>(step)[0].lease, lease.lease);
  EXPECT_EQ(in<action::Lease>(step)[0].session, 2u);
  EXPECT_EQ(in<action::Lease>(step)[0].band, lease.band);
}

TEST(BandFailures, LeasesAFailedBandToAnotherWorker) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  farm.hello(2, "b");
  const Step step = farm.send(input::BandFailed{1, first[0].lease, "out of memory", {}});
  ASSERT_EQ(in<action::Lease>(step).size(), 1u);
  EXPECT_EQ(in<action::Lease>(step)[0].session, 2u);
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
}

TEST(BandFailures, ThreeFailuresOfABandFailTheJobWithTheReason) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_GT(farm.all<action::Lease>().size(), i);
    farm.send(input::BandFailed{
        1, farm.all<action::Lease>()[i].lease, "out of memory", {"its last line"}});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  EXPECT_NE(farm.job(job).reason.find("out of memory"), std::string::npos);
  EXPECT_EQ(farm.job(job).log_of, "worker-a");
  EXPECT_EQ(farm.job(job).log, std::vector<std::string>{"its last line"});
  EXPECT_EQ(farm.scheduler.why(job, farm.now).at(1), "worker-a | its last line");
  EXPECT_EQ(farm.all<action::LogFailure>().size(), 3u);
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  EXPECT_EQ(next.job(job).log, std::vector<std::string>{"its last line"});
  EXPECT_EQ(farm.all<action::DropBands>().size(), 1u);
}

/// Fails every band that the session is leased.
void fail_all(FarmDriver& farm, SessionId session) {
  for (std::size_t i = 0; i < farm.all<action::Lease>().size(); ++i) {
    const action::Lease lease = farm.all<action::Lease>()[i];
    if (lease.session == session) {
      farm.send(
          input::BandFailed{session, lease.lease, "cannot read the scene", {"its last line"}});
    }
  }
}

TEST(BandFailures, AJobFailsIfNoConnectedWorkerMayRenderIt) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 64));
  farm.hello(1, "a", 3);
  farm.hello(2, "b", 3);
  fail_all(farm, 1);
  fail_all(farm, 2);
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  EXPECT_NE(farm.scheduler.why(job, farm.now).at(0).find("no connected worker can render it"),
            std::string::npos);
  farm.pass_time(60, {1, 2});
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  for (const char* part : {"each worker", "3 of its bands", "worker-b", "cannot read the scene"}) {
    EXPECT_NE(farm.job(job).reason.find(part), std::string::npos) << farm.job(job).reason;
  }
  EXPECT_EQ(farm.job(job).log, std::vector<std::string>{"its last line"});
}

TEST(BandFailures, AJobWaitsALimitedTimeForAWorkerThatMayRenderIt) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 64));
  farm.hello(1, "a", 3);
  farm.hello(2, "b", 1);
  fail_all(farm, 1);
  farm.send(input::SessionEnded{2, "connection reset"});
  farm.pass_time(3, {1});
  farm.hello(3, "b", 1);
  farm.pass_time(20, {1, 3});
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  farm.send(input::SessionEnded{3, "connection reset"});
  farm.pass_time(60, {1});
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  EXPECT_NE(farm.job(job).reason.find("cannot read the scene"), std::string::npos);
}

TEST(BandFailures, ReconnectsOfAFailingWorkerDoNotKeepTheJobRunning) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 64));
  farm.hello(1, "a", 3);
  fail_all(farm, 1);
  for (SessionId session = 2; session < 20; ++session) {
    farm.pass_time(4, {session - 1});
    farm.send(input::SessionEnded{session - 1, "a bad cable"});
    farm.pass_time(1);
    farm.hello(session, "a", 3);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
}

TEST(BandFailures, AWorkerThatFailsNowAndThenKeepsItsJob) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 64));
  farm.hello(1, "a", 1);
  for (int i = 0; i < 12; ++i) {
    const action::Lease lease = farm.all<action::Lease>().back();
    if (i % 3 == 2) {
      farm.stored(lease, "a");
    } else {
      farm.send(input::BandFailed{1, lease.lease, "out of memory", {}});
    }
    ASSERT_EQ(farm.job(job).state, JobState::kRunning) << i;
  }
}

/// Connects a worker, which gets the first band. Then disconnects the worker.
void lose_one(FarmDriver& farm, SessionId session, const std::string& instance) {
  farm.hello(session, instance, 1);
  farm.send(input::SessionEnded{session, "connection reset"});
}

/// Connects a new worker, which renders one band, gets the next and is lost.
void store_one_and_lose(FarmDriver& farm, SessionId session) {
  const std::string instance = std::to_string(session);
  farm.hello(session, instance, 1);
  farm.stored(farm.all<action::Lease>().back(), instance);
  farm.send(input::SessionEnded{session, "connection reset"});
}

// The first crash makes the band suspect: the band may have caused the crash. A new farm, of which
// nothing is known, requires five more crashes before it blames the band (CrashRate).
TEST(CrashAttribution, SixCrashesOnANewFarmFailTheJobAndNameTheBand) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  const std::string names = "abcdef";
  for (SessionId session = 1; session <= 6; ++session) {
    EXPECT_EQ(farm.job(job).state, JobState::kRunning)
        << "fewer than six crashes must not fail the job";
    lose_one(farm, session, names.substr(session - 1, 1));
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  const std::string reason = farm.job(job).reason;
  for (const char* part :
       {"6 workers", "rows 0–1", "samples 0–8", "worker-a", "connection reset"}) {
    EXPECT_NE(reason.find(part), std::string::npos) << part << " in: " << reason;
  }
}

TEST(CrashAttribution, DoesNotCountWorkersThatReconnectOrDrain) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  for (SessionId session = 1; session < 20; ++session) {
    lose_one(farm, session, "a");  // a bad cable
  }
  for (SessionId session = 20; session < 30; ++session) {
    farm.hello(session, std::to_string(session), 1);
    farm.send(input::Draining{session, "SIGTERM"});
    farm.send(input::SessionEnded{session, "it left"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

TEST(CrashAttribution, StoredRowsAreNotSuspect) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 8));
  for (SessionId session = 1; session <= 6; ++session) {
    store_one_and_lose(farm, session);
  }
  EXPECT_NE(farm.job(job).state, JobState::kFailed) << farm.job(job).reason;
}

TEST(Liveness, RefusesAnIncompatibleWorkerAndNamesTheDifference) {
  FarmDriver farm;
  WorkerHello worker;
  worker.instance = "a";
  worker.protocol = 1;
  worker.pixel_version = 1;
  worker.canary = 3;
  worker.build = "old build";
  const auto refused = in<action::Refuse>(farm.send(input::Hello{1, worker}));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].reason,
            "pixel version 1, the coordinator's is 2: build old build; update the worker");
  EXPECT_GT(refused[0].retry_after_ms, 0u);
}

TEST(Liveness, ADrainingWorkerKeepsItsLeasesAndGetsNoMore) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{64}));
  farm.hello(1, "a");
  farm.send(input::Draining{1, "SIGTERM"});
  const auto leases = farm.all<action::Lease>();
  farm.stored(leases[0], "a");
  EXPECT_EQ(farm.all<action::Lease>().size(), leases.size());
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  EXPECT_EQ(farm.scheduler.workers(farm.now)[0].state, "draining");
}

/// Starts a new worker that renders bands until it gets a band with this row. Then the worker is
/// lost. Returns the band with the row.
Band lose_one_at(FarmDriver& farm, std::uint32_t row, SessionId session) {
  const std::string instance = std::to_string(session);
  farm.hello(session, instance, 1);
  Band band = farm.all<action::Lease>().back().band;
  while (row < band.rows.first || band.rows.last <= row) {
    farm.stored(farm.all<action::Lease>().back(), instance);
    band = farm.all<action::Lease>().back().band;
  }
  farm.send(input::SessionEnded{session, "connection reset"});
  return band;
}

// Each worker that renders row 23 is lost. The band is retried in eight pieces, of which one is
// blamed.
TEST(CrashAttribution, FindsOneDeadlyRowOfALongBand) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 800));
  const Band first = lose_one_at(farm, 23, 1);
  ASSERT_GE(first.rows.count(), 24u);
  const Band second = lose_one_at(farm, 23, 2);
  EXPECT_LE(second.rows.count(), (first.rows.count() + 7) / 8);
  for (SessionId session = 3; session <= 6; ++session) {
    ASSERT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
    EXPECT_EQ(lose_one_at(farm, 23, session), second);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  const std::string rows =
      "rows " + std::to_string(second.rows.first) + "–" + std::to_string(second.rows.last);
  EXPECT_NE(farm.job(job).reason.find(rows), std::string::npos) << farm.job(job).reason;
}

// If a worker crashes at the first pixel of its second band, its first band may be finished but not
// stored yet. Then the worker holds the leases of both bands, and both are suspect.
TEST(CrashAttribution, TheSecondLeaseIsSuspectToo) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 2));
  farm.hello(1, "a", 2);
  const std::vector<action::Lease> held = farm.all<action::Lease>();
  ASSERT_EQ(held.size(), 2u);
  farm.send(input::SessionEnded{1, "connection reset"});
  farm.actions.clear();
  farm.hello(2, "b", 3);
  const std::vector<action::Lease> again = farm.all<action::Lease>();
  ASSERT_EQ(again.size(), 1u) << "a suspect band is given alone";
  farm.stored(again[0], "b");
  ASSERT_EQ(farm.all<action::Lease>().size(), 2u) << "the other suspect band is given alone, too";
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
}

// A worker may be rendering a revoked lease until its heartbeat no longer names the lease.
TEST(CrashAttribution, ABandIsNotBlamedForARevokedLease) {
  FarmDriver farm;
  const JobId deadly = farm.submit(test_job("deadly", StopAtSamples{8}, 8, 1));
  const JobId sound = farm.submit(test_job("sound", StopAtSamples{8}, 8, 1));
  for (SessionId session = 1; session <= 8; ++session) {
    const std::string instance = std::to_string(session);
    farm.hello(session, instance, 1);
    farm.send(input::Pause{deadly});
    farm.pass_time(1.5);  // the lease of `deadly` is revoked, `sound` has free rows
    if (session > 1) {
      EXPECT_NE(farm.all<action::Lease>().back().job, sound)
          << "`sound` must not be leased before a heartbeat omits the revoked lease";
    }
    farm.send(input::SessionEnded{session, "connection reset"});
    farm.send(input::Resume{deadly});
  }
  EXPECT_EQ(farm.job(sound).state, JobState::kRunning) << farm.job(sound).reason;
}

TEST(CrashAttribution, CrashesOfOneMachineDoNotFailAJobThatAnotherCanRender) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 64));
  farm.hello(100, "good", 1);
  for (SessionId session = 1; session <= 12; ++session) {
    WorkerHello bad;
    bad.instance = std::to_string(session);
    bad.name = "bad";
    bad.protocol = 1;
    bad.pixel_version = 2;
    bad.canary = 3;
    bad.max_bands = 1;
    farm.send(input::Hello{session, bad});
    farm.heartbeat(100);
    farm.send(input::SessionEnded{session, "connection reset"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
  farm.render_all(100, "good");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing) << farm.job(job).reason;
}

TEST(CrashAttribution, CrashesOfTheOnlyMachineFailTheJob) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  for (SessionId session = 1; session <= 6; ++session) {
    EXPECT_EQ(farm.job(job).state, JobState::kRunning);
    WorkerHello only;
    only.instance = std::to_string(session);
    only.name = "only";
    only.protocol = 1;
    only.pixel_version = 2;
    only.canary = 3;
    farm.send(input::Hello{session, only});
    farm.send(input::SessionEnded{session, "connection reset"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
}

// required(least, own) returns the number of crashes at one band after which the band is blamed. It
// is at least `least`. `own` crashes were at this band and are left out of the rate.
TEST(CrashRate, RequiresMoreCrashesIfMoreWorkersAreLost) {
  CrashRate calm;
  EXPECT_EQ(calm.required(3, 0), 5u) << "a new farm must require five crashes";
  calm.add_crash();
  EXPECT_EQ(calm.required(3, 1), 5u) << "the crash at this band must not count";
  EXPECT_GT(calm.required(3, 0), 5u);
  for (int i = 0; i < 100; ++i) {
    calm.add_band();
  }
  EXPECT_EQ(calm.required(3, 1), 3u);
  CrashRate storm;
  for (int i = 0; i < 500; ++i) {
    storm.add_band();
    storm.add_crash();
  }
  // A worker is lost at half of all bands. The probability that 20 workers are lost at one band by
  // chance is 2^-20, about 1e-6, which is the limit.
  EXPECT_EQ(storm.required(3, 0), 20u);
  for (int i = 0; i < 100'000; ++i) {
    storm.add_band();
  }
  EXPECT_EQ(storm.required(3, 0), 3u) << "old events must lose weight";
}

TEST(CrashAttribution, RandomKillsDoNotFailAJobThatAdvances) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 800));
  lose_one_at(farm, 0, 1);
  for (SessionId session = 2; session <= 9; ++session) {
    store_one_and_lose(farm, session);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

// Each worker is silent when it gets the band, and is disconnected for this silence.
TEST(CrashAttribution, DoesNotCountAWorkerThatWasSilentBefore) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  for (SessionId session = 1; session <= 5; ++session) {
    farm.send(input::Pause{job});
    farm.hello(session, std::to_string(session), 1);
    farm.pass_time(3);
    farm.send(input::Resume{job});
    ASSERT_EQ(farm.all<action::Lease>().size(), session);
    farm.pass_time(2);
    ASSERT_EQ(farm.all<action::Close>().size(), session);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

}  // namespace
}  // namespace bandsaw::coordinator
