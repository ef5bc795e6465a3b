// Workers that go, freeze, come back, fail and lie.

#include "coordinator/core/loss_rate.h"
#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

TEST(Loss, ABandOfALostWorkerIsGivenToAnother) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  ASSERT_EQ(first.size(), 1u);
  farm.hello(2, "b");
  const Step step = farm.say(input::Lost{1, "connection reset"});
  const auto again = in<action::Lease>(step);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].session, 2u);
  EXPECT_EQ(again[0].band, first[0].band);
  EXPECT_EQ(again[0].attempt, 2u);
  farm.stored(again[0], "b");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

TEST(Loss, ALateResultCountsAndEndsTheSecondAttempt) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  farm.hello(2, "b");
  farm.say(input::Lost{1, "connection reset"});
  const Step late = farm.stored(first[0], "a");
  ASSERT_EQ(in<action::Revoke>(late).size(), 1u);
  EXPECT_EQ(in<action::Revoke>(late)[0].session, 2u);
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
}

TEST(Loss, ASilentWorkerIsClosedAndItsBandGivenToAnother) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  farm.hello(2, "b");
  farm.pass_time(6, {2});
  EXPECT_EQ(farm.all<action::Close>().size(), 1u);
  EXPECT_EQ(farm.all<action::Lease>().back().session, 2u);
}

TEST(Loss, AClockThatJumpsLosesNobody) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  farm.now += 1e6;
  farm.say(input::Tick{});
  farm.now -= 2e6;
  farm.say(input::Tick{});
  EXPECT_TRUE(farm.all<action::Close>().empty());
}

TEST(Loss, AWorkerThatIsHeardOfButDoesNotAdvanceLosesItsBand) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  farm.pass_time(20, {1});
  const LeaseId id = farm.all<action::Lease>()[0].lease;
  farm.say(input::Heartbeat{1, {{id, 0, true, 17}}, "fetching scene"});
  farm.pass_time(20, {1});
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  farm.pass_time(20, {1});
  EXPECT_FALSE(farm.all<action::Revoke>().empty());
}

// What is rendered is on its way, by a line that may be slow; but not for ever.
TEST(Loss, ABandThatIsSentHasTime) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>()[0];
  farm.say(input::Heartbeat{1, {{lease.lease, lease.band.rows.count(), true, 0}}, "sending"});
  farm.pass_time(300, {1});
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  farm.pass_time(600, {1});
  EXPECT_FALSE(farm.all<action::Revoke>().empty());
}

TEST(Loss, AReconnectTakesTheSameLeaseUpAgain) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{16}, 8, 2));
  farm.hello(1, "a");
  const auto leases = farm.all<action::Lease>();
  const action::Lease lease = leases[0];
  const Step step = farm.hello(2, "a", 2, {{lease.job, lease.band, lease.lease, "one", false}});
  ASSERT_EQ(in<action::Close>(step).size(), 1u);
  EXPECT_EQ(in<action::Close>(step)[0].session, 1u);
  ASSERT_FALSE(in<action::Lease>(step).empty());
  EXPECT_EQ(in<action::Lease>(step)[0].lease, lease.lease);
  EXPECT_EQ(in<action::Lease>(step)[0].session, 2u);
  EXPECT_EQ(in<action::Lease>(step)[0].band, lease.band);
}

TEST(Loss, ABandThatOneWorkerCannotRenderGoesToAnother) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  const auto first = farm.all<action::Lease>();
  farm.hello(2, "b");
  const Step step = farm.say(input::BandFailed{1, first[0].lease, "out of memory", {}});
  ASSERT_EQ(in<action::Lease>(step).size(), 1u);
  EXPECT_EQ(in<action::Lease>(step)[0].session, 2u);
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
}

TEST(Loss, ABandThatFailsThreeTimesFailsTheJobWithTheReason) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a");
  for (std::size_t i = 0; i < 3; ++i) {
    ASSERT_GT(farm.all<action::Lease>().size(), i);
    farm.say(input::BandFailed{
        1, farm.all<action::Lease>()[i].lease, "out of memory", {"its last line"}});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  EXPECT_NE(farm.job(job).reason.find("out of memory"), std::string::npos);
  EXPECT_EQ(farm.job(job).log_of, "worker-a");
  EXPECT_EQ(farm.job(job).log, std::vector<std::string>{"its last line"});
  EXPECT_EQ(farm.core.why(job, farm.now).at(1), "worker-a | its last line");
  EXPECT_EQ(farm.all<action::Faulted>().size(), 3u);
  FarmDriver next;
  for (const Record& record : farm.records) {
    next.core.replay(record);
  }
  EXPECT_EQ(next.job(job).log, std::vector<std::string>{"its last line"});
  EXPECT_EQ(farm.all<action::DropBands>().size(), 1u);
}

/// Every band that the session is given fails.
void fail_all(FarmDriver& farm, SessionId session) {
  for (std::size_t i = 0; i < farm.all<action::Lease>().size(); ++i) {
    const action::Lease lease = farm.all<action::Lease>()[i];
    if (lease.session == session) {
      farm.say(input::BandFailed{session, lease.lease, "cannot read the scene", {"its last line"}});
    }
  }
}

TEST(Loss, AJobThatNoConnectedWorkerCanRenderFails) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 64));
  farm.hello(1, "a", 3);
  farm.hello(2, "b", 3);
  fail_all(farm, 1);
  fail_all(farm, 2);
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  EXPECT_NE(farm.core.why(job, farm.now).at(0).find("no connected worker can render it"),
            std::string::npos);
  farm.pass_time(60, {1, 2});
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  for (const char* part : {"each worker", "3 of its bands", "worker-b", "cannot read the scene"}) {
    EXPECT_NE(farm.job(job).reason.find(part), std::string::npos) << farm.job(job).reason;
  }
  EXPECT_EQ(farm.job(job).log, std::vector<std::string>{"its last line"});
}

TEST(Loss, AJobWaitsForTheOneThatCanRenderItButNotForEver) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 64));
  farm.hello(1, "a", 3);
  farm.hello(2, "b", 1);
  fail_all(farm, 1);
  farm.say(input::Lost{2, "connection reset"});
  farm.pass_time(3, {1});
  farm.hello(3, "b", 1);
  farm.pass_time(20, {1, 3});
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  farm.say(input::Lost{3, "connection reset"});
  farm.pass_time(60, {1});
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  EXPECT_NE(farm.job(job).reason.find("cannot read the scene"), std::string::npos);
}

TEST(Loss, AWorkerThatCannotRenderItAndComesAndGoesIsNoHope) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 64));
  farm.hello(1, "a", 3);
  fail_all(farm, 1);
  for (SessionId session = 2; session < 20; ++session) {
    farm.pass_time(4, {session - 1});
    farm.say(input::Lost{session - 1, "a bad cable"});
    farm.pass_time(1);
    farm.hello(session, "a", 3);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
}

TEST(Loss, AWorkerThatFailsNowAndThenKeepsItsJob) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 64));
  farm.hello(1, "a", 1);
  for (int i = 0; i < 12; ++i) {
    const action::Lease lease = farm.all<action::Lease>().back();
    if (i % 3 == 2) {
      farm.stored(lease, "a");
    } else {
      farm.say(input::BandFailed{1, lease.lease, "out of memory", {}});
    }
    ASSERT_EQ(farm.job(job).state, JobState::kRunning) << i;
  }
}

/// A worker that takes the first band and goes.
void lose_one(FarmDriver& farm, SessionId session, const std::string& instance) {
  farm.hello(session, instance, 1);
  farm.say(input::Lost{session, "connection reset"});
}

/// A new worker that renders one band, is given the next and goes.
void store_one_and_lose(FarmDriver& farm, SessionId session) {
  const std::string instance = std::to_string(session);
  farm.hello(session, instance, 1);
  farm.stored(farm.all<action::Lease>().back(), instance);
  farm.say(input::Lost{session, "connection reset"});
}

TEST(Poison, ABandThatEndsSixWorkersOfANewFarmFailsTheJobAndIsNamed) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  const std::string names = "abcdef";
  for (SessionId session = 1; session <= 6; ++session) {
    EXPECT_EQ(farm.job(job).state, JobState::kRunning) << "the first only made it suspect";
    lose_one(farm, session, names.substr(session - 1, 1));
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
  const std::string reason = farm.job(job).reason;
  for (const char* part :
       {"6 workers", "rows 0–1", "samples 0–16", "worker-a", "connection reset"}) {
    EXPECT_NE(reason.find(part), std::string::npos) << part << " in: " << reason;
  }
}

TEST(Poison, WorkersThatComeBackOrSayThatTheyLeaveAreNotCounted) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  for (SessionId session = 1; session < 20; ++session) {
    lose_one(farm, session, "a");  // a bad cable
  }
  for (SessionId session = 20; session < 30; ++session) {
    farm.hello(session, std::to_string(session), 1);
    farm.say(input::Draining{session, "SIGTERM"});
    farm.say(input::Lost{session, "it left"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

TEST(Poison, RowsThatWereStoredSinceAreNotSuspected) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 8));
  for (SessionId session = 1; session <= 6; ++session) {
    store_one_and_lose(farm, session);
  }
  EXPECT_NE(farm.job(job).state, JobState::kFailed) << farm.job(job).reason;
}

TEST(Loss, AWorkerThatDiffersIsRefusedWithWhatDiffers) {
  FarmDriver farm;
  WorkerHello worker;
  worker.instance = "a";
  worker.protocol = 1;
  worker.pixel_version = 1;
  worker.canary = 3;
  worker.build = "old build";
  const auto refused = in<action::Refuse>(farm.say(input::Hello{1, worker}));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_EQ(refused[0].reason,
            "pixel version 1, the coordinator's is 2: build old build; update the worker");
  EXPECT_GT(refused[0].retry_after_ms, 0u);
}

TEST(Loss, ADrainingWorkerKeepsWhatItHasAndGetsNothingMore) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{64}));
  farm.hello(1, "a");
  farm.say(input::Draining{1, "SIGTERM"});
  const auto leases = farm.all<action::Lease>();
  farm.stored(leases[0], "a");
  EXPECT_EQ(farm.all<action::Lease>().size(), leases.size());
  EXPECT_TRUE(farm.all<action::Revoke>().empty());
  EXPECT_EQ(farm.core.workers(farm.now)[0].state, "draining");
}

/// Starts a new worker that renders bands until one of them holds the row, and is lost with it.
Band lose_one_at(FarmDriver& farm, std::uint32_t row, SessionId session) {
  const std::string instance = std::to_string(session);
  farm.hello(session, instance, 1);
  Band band = farm.all<action::Lease>().back().band;
  while (row < band.rows.first || band.rows.last <= row) {
    farm.stored(farm.all<action::Lease>().back(), instance);
    band = farm.all<action::Lease>().back().band;
  }
  farm.say(input::Lost{session, "connection reset"});
  return band;
}

TEST(Poison, OneDeadlyRowOfALongBandIsNarrowedDown) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 800));
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

// Whoever dies at the first pixel of a band still has the one before it, finished and not stored.
TEST(Poison, TheBandBehindTheFirstIsSuspectToo) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 2));
  farm.hello(1, "a", 2);
  const std::vector<action::Lease> held = farm.all<action::Lease>();
  ASSERT_EQ(held.size(), 2u);
  farm.say(input::Lost{1, "connection reset"});
  farm.actions.clear();
  farm.hello(2, "b", 3);
  const std::vector<action::Lease> again = farm.all<action::Lease>();
  ASSERT_EQ(again.size(), 1u) << "a suspect band is given alone";
  farm.stored(again[0], "b");
  ASSERT_EQ(farm.all<action::Lease>().size(), 2u) << "so is the other";
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
}

// A worker that was told to drop a band may be at it until it is heard of without it.
TEST(Poison, ABandIsNotBlamedForOneThatItsWorkerWasToldToDrop) {
  FarmDriver farm;
  const JobId deadly = farm.submit(test_job("deadly", StopAtSamples{16}, 8, 1));
  const JobId sound = farm.submit(test_job("sound", StopAtSamples{16}, 8, 1));
  for (SessionId session = 1; session <= 8; ++session) {
    const std::string instance = std::to_string(session);
    farm.hello(session, instance, 1);
    farm.say(input::Pause{deadly});
    farm.pass_time(1.5);  // the band is taken back, the sound one is given
    if (session > 1) {
      EXPECT_NE(farm.all<action::Lease>().back().job, sound) << "not before it is heard of";
    }
    farm.say(input::Lost{session, "connection reset"});
    farm.say(input::Resume{deadly});
  }
  EXPECT_EQ(farm.job(sound).state, JobState::kRunning) << farm.job(sound).reason;
}

TEST(Poison, OneBadMachineIsNoProofWhileThereIsAnother) {
  FarmDriver farm(slow());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 64));
  farm.hello(100, "good", 1);
  for (SessionId session = 1; session <= 12; ++session) {
    WorkerHello bad;
    bad.instance = std::to_string(session);
    bad.name = "bad";
    bad.protocol = 1;
    bad.pixel_version = 2;
    bad.canary = 3;
    bad.max_bands = 1;
    farm.say(input::Hello{session, bad});
    farm.heartbeat(100);
    farm.say(input::Lost{session, "connection reset"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
  farm.render_all(100, "good");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing) << farm.job(job).reason;
}

TEST(Poison, OneMachineThatIsAloneIsProof) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  for (SessionId session = 1; session <= 6; ++session) {
    EXPECT_EQ(farm.job(job).state, JobState::kRunning);
    WorkerHello only;
    only.instance = std::to_string(session);
    only.name = "only";
    only.protocol = 1;
    only.pixel_version = 2;
    only.canary = 3;
    farm.say(input::Hello{session, only});
    farm.say(input::Lost{session, "connection reset"});
  }
  EXPECT_EQ(farm.job(job).state, JobState::kFailed);
}

TEST(LossRate, AsksForMoreWitnessesWhereMoreIsLost) {
  LossRate calm;
  EXPECT_EQ(calm.witnesses(3, 0), 5u) << "nothing is known of a new farm";
  calm.add_loss();
  EXPECT_EQ(calm.witnesses(3, 1), 5u) << "the band's own loss says nothing of the farm";
  EXPECT_GT(calm.witnesses(3, 0), 5u);
  for (int i = 0; i < 100; ++i) {
    calm.add_band();
  }
  EXPECT_EQ(calm.witnesses(3, 1), 3u);
  LossRate storm;
  for (int i = 0; i < 500; ++i) {
    storm.add_band();
    storm.add_loss();
  }
  // Half of all bands lose their worker: 2^-20 is 1e-6.
  EXPECT_EQ(storm.witnesses(3, 0), 20u);
  for (int i = 0; i < 100'000; ++i) {
    storm.add_band();
  }
  EXPECT_EQ(storm.witnesses(3, 0), 3u) << "what is long past is forgotten";
}

TEST(Poison, WorkersThatAreKilledOneAfterTheOtherDoNotFailAJobThatAdvances) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 800));
  lose_one_at(farm, 0, 1);
  for (SessionId session = 2; session <= 9; ++session) {
    store_one_and_lose(farm, session);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

TEST(Poison, WhoFellSilentBeforeItWasGivenTheBandIsNotCounted) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  for (SessionId session = 1; session <= 5; ++session) {
    farm.say(input::Pause{job});
    farm.hello(session, std::to_string(session), 1);
    farm.pass_time(3);
    farm.say(input::Resume{job});
    ASSERT_EQ(farm.all<action::Lease>().size(), session);
    farm.pass_time(2);
    ASSERT_EQ(farm.all<action::Close>().size(), session);
  }
  EXPECT_EQ(farm.job(job).state, JobState::kRunning) << farm.job(job).reason;
}

}  // namespace
}  // namespace bandsaw::coordinator
