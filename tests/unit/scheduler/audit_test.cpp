// Audits. A second machine renders some of the bands again, and the scheduler compares the results.
// These tests cover the selection of bands and machines, and disputes. In a dispute, machines have
// returned different pixels of a row. A machine that is found to be wrong is quarantined, and its
// stored rows are retracted: they count as not rendered.

#include "coordinator/scheduler/model/audit.h"
#include "coordinator/scheduler/api/worker_process.h"
#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

/// All bands are audited. The options slow() give each band one row or a few.
SchedulerOptions audited() {
  SchedulerOptions options = slow();
  options.audit_share = 1;
  return options;
}

/// A farm in which the test answers each lease by a call of `result`.
struct AuditFarm : FarmDriver {
  explicit AuditFarm(SchedulerOptions options = audited()) : FarmDriver(std::move(options)) {}

  /// Returns the newest lease of a session, either of an audit or of another band.
  action::Lease lease(SessionId session, bool audit) const {
    action::Lease found;
    for (const auto& lease : all<action::Lease>()) {
      found = lease.session == session && lease.audit == audit ? lease : found;
    }
    EXPECT_NE(found.lease, 0u) << "session " << session;
    return found;
  }

  /// Sends the result of a lease. `lie`: added to the digest of its first row; 0: right pixels.
  Step result(const action::Lease& lease, const std::string& instance, std::uint64_t lie = 0) {
    input::BandStored in;
    in.job = lease.job;
    in.band = lease.band;
    in.row_digests = honest_digests(lease.band);
    in.row_digests[0] += lie;
    in.instance = instance;
    in.render_s = 0.1;
    in.written = !lease.audit;  // the pixels of an audit are only compared
    return send(in);
  }

  std::string state_of(const std::string& name) const {
    for (const WorkerView& worker : scheduler.workers(now)) {
      if (worker.name == name) {
        return worker.state;
      }
    }
    return "unknown";
  }
};

/// A job of one row. Worker a renders the row, and worker b renders the row again for the audit.
/// `lie_of_a`, `lie_of_b`: as in AuditFarm::result. `third`: c is connected as a third machine.
AuditFarm two_results(std::uint64_t lie_of_a, std::uint64_t lie_of_b, bool third = false) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  farm.result(farm.lease(1, false), "a", lie_of_a);
  EXPECT_EQ(farm.job(1).state, JobState::kRunning) << "the audit is still open";
  if (third) {
    farm.hello(3, "c", 1);
  }
  farm.result(farm.lease(2, true), "b", lie_of_b);
  return farm;
}

TEST(Audit, SelectsTheGivenShareOfBandsIndependentlyForEachJob) {
  const JobSpec spec = test_job("a request that nobody guesses", StopAtSamples{8});
  const JobSpec other = test_job("another", StopAtSamples{8});
  int count = 0;
  int both = 0;
  for (std::uint32_t row = 0; row < 20'000; ++row) {
    const Band band{{0, 8}, {row, row + 1}};
    const bool one = is_audited(spec, band, 0.05);
    count += one ? 1 : 0;
    both += one && is_audited(other, band, 0.05) ? 1 : 0;
    EXPECT_FALSE(is_audited(spec, band, 0));
    EXPECT_TRUE(is_audited(spec, band, 1));
  }
  // The tolerances are four standard deviations. The standard deviation of `count` is
  // sqrt(20,000 x 0.05 x 0.95) = 31, and that of `both` is sqrt(20,000 x 0.05^2) = 7.
  EXPECT_NEAR(count, 1'000, 4 * 31);
  EXPECT_NEAR(both, 50, 4 * 7) << "the selections of two jobs are independent";
}

TEST(Audit, ASecondMachineRendersTheBandAndTheJobEnds) {
  AuditFarm farm = two_results(0, 0);
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
  EXPECT_EQ(farm.all_records<record::BandAudited>().size(), 1u);
  EXPECT_TRUE(farm.all_records<record::WorkerQuarantined>().empty());
}

TEST(Audit, WithOneMachineAuditsDoNotBlockTheJob) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  farm.result(farm.lease(1, false), "a");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
  EXPECT_EQ(farm.all<action::Lease>().size(), 1u);
}

TEST(Audit, AnAuditWithoutAMachineDoesNotStopATimedJob) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtTime{.seconds = 10}, 8, 1));
  farm.hello(1, "a", 1);
  for (int band = 0; band < 20; ++band) {
    const std::size_t leases = farm.all<action::Lease>().size();
    farm.now += 0.1;
    farm.result(farm.all<action::Lease>().back(), "a");
    EXPECT_EQ(farm.all<action::Lease>().size(), leases + 1);
  }
}

TEST(Audit, AMachineDoesNotConfirmItself) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  WorkerHello sibling;  // another process with the same name: it is on the same machine
  sibling.instance = "b";
  sibling.name = "worker-a";
  sibling.protocol = 1;
  sibling.pixel_version = 2;
  sibling.canary = 3;
  farm.send(input::Hello{2, sibling});
  farm.result(farm.lease(1, false), "a");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

TEST(Audit, AThirdMachineDecidesAndWrongRowsAreRenderedAgain) {
  AuditFarm farm = two_results(7, 0, /*third=*/true);
  const Step step = farm.result(farm.lease(3, true), "c");
  EXPECT_EQ(farm.state_of("worker-a"), "quarantined");
  EXPECT_EQ(farm.state_of("worker-b"), "rendering");
  ASSERT_EQ(in<action::Retract>(step).size(), 1u);
  EXPECT_EQ(in<action::Retract>(step)[0].process, worker_process_id("a"));
  EXPECT_EQ(farm.job(1).samples_done, 0u);
  EXPECT_NE(farm.job(1).reason.find("pixels that differ from the accepted result"),
            std::string::npos)
      << farm.job(1).reason;
  // One of b and c, whose sessions are 2 and 3, renders the row. The other worker audits it.
  const SessionId again = farm.all<action::Lease>().back().session;
  const std::string who[] = {"", "", "b", "c"};
  farm.result(farm.lease(again, false), who[again]);
  farm.result(farm.lease(5 - again, true), who[5 - again]);
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

TEST(Audit, AWrongAuditorIsQuarantinedAndTheRowsStay) {
  AuditFarm farm = two_results(0, 7, /*third=*/true);
  const Step step = farm.result(farm.lease(3, true), "c");
  EXPECT_EQ(farm.state_of("worker-b"), "quarantined");
  EXPECT_TRUE(in<action::Retract>(step).empty());
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

TEST(Audit, TheMachineThatContradictsItselfIsWrong) {
  AuditFarm farm = two_results(7, 0);
  // There is no third machine, so each of the two machines renders the row again.
  farm.result(farm.lease(1, true), "a", 8);
  EXPECT_EQ(farm.state_of("worker-a"), "quarantined");
  EXPECT_EQ(farm.all_records<record::WorkerQuarantined>()[0].name, "worker-a");
  farm.result(farm.lease(2, false), "b");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

TEST(Audit, TwoMachinesThatRepeatTheirResultsWaitForAThird) {
  AuditFarm farm = two_results(7, 0);
  farm.result(farm.lease(1, true), "a", 7);
  farm.result(farm.lease(2, true), "b", 0);
  const std::size_t leases = farm.all<action::Lease>().size();
  farm.pass_time(100, {1, 2});
  EXPECT_EQ(farm.all<action::Lease>().size(), leases)
      << "each machine must render the row again only once";
  EXPECT_EQ(farm.job(1).state, JobState::kRunning);
  EXPECT_NE(farm.job(1).reason.find("another machine must decide"), std::string::npos)
      << farm.job(1).reason;
  farm.send(input::Quarantine{"worker-a"});
  farm.result(farm.lease(2, false), "b");
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing);
}

/// Returns the farm of two_results after a restart that selects no bands for audits. `records` are
/// those of the journal, or of a snapshot that replaces them. The row that worker a stored is on
/// disk.
AuditFarm after_restart(const AuditFarm& farm, const std::vector<Record>& records,
                        std::uint64_t lie_of_a) {
  SchedulerOptions options = slow();
  options.epoch = "two";
  options.audit_share = 0;
  AuditFarm next(options);
  for (const Record& record : records) {
    next.scheduler.replay(record);
  }
  input::BandStored row;
  row.job = 1;
  row.band = farm.lease(1, false).band;
  row.row_digests = honest_digests(row.band);
  row.row_digests[0] += lie_of_a;
  row.process = worker_process_id("a");
  next.scheduler.replay(row);
  next.take(next.scheduler.replayed(next.now));
  return next;
}

// The processes of both machines are new too, as after a power failure. None of them confirms what
// an earlier process of its machine returned.
TEST(Audit, ADisputeIsStillOpenAfterARestart) {
  AuditFarm farm = two_results(7, 0);
  farm.result(farm.lease(1, true), "a", 7);
  farm.result(farm.lease(2, true), "b", 0);
  EXPECT_EQ(farm.all_records<record::RowDisputed>().size(), 1u);
  for (const std::vector<Record>& records : {farm.records, farm.scheduler.snapshot()}) {
    AuditFarm next = after_restart(farm, records, 7);
    EXPECT_EQ(next.job(1).state, JobState::kRunning);
    WorkerHello a = test_worker("a2", 1);
    a.name = "worker-a";
    WorkerHello b = test_worker("b2", 1);
    b.name = "worker-b";
    next.send(input::Hello{1, a});
    next.send(input::Hello{2, b});
    // The former processes do not reconnect. a2 gets the first lease. b2 gets the second lease,
    // because a2 is late. After that, a2 gets another lease.
    next.pass_time(8, {1, 2});
    next.result(next.lease(2, true), "b2", 0);
    next.result(next.lease(1, true), "a2", 7);
    next.pass_time(20, {1, 2});
    EXPECT_TRUE(next.all_records<record::WorkerQuarantined>().empty());
    EXPECT_EQ(next.job(1).state, JobState::kRunning);
    EXPECT_NE(next.job(1).reason.find("worker-a, worker-b returned different pixels"),
              std::string::npos)
        << next.job(1).reason;
    next.send(input::Quarantine{"worker-a"});
    next.result(next.lease(2, false), "b2");
    EXPECT_EQ(next.job(1).state, JobState::kFinishing);
  }
}

TEST(Audit, ADecidedDisputeIsNotOpenedAfterARestart) {
  AuditFarm by_third = two_results(0, 7, /*third=*/true);
  by_third.result(by_third.lease(3, true), "c");
  EXPECT_EQ(by_third.all_records<record::RowDisputed>().size(), 1u);
  EXPECT_EQ(by_third.job(1).state, JobState::kFinishing);
  AuditFarm by_user = two_results(0, 7);
  by_user.send(input::Quarantine{"worker-b"});
  for (const AuditFarm* farm : {&by_third, &by_user}) {
    for (const std::vector<Record>& records : {farm->records, farm->scheduler.snapshot()}) {
      const AuditFarm next = after_restart(*farm, records, 0);
      EXPECT_EQ(next.job(1).state, JobState::kFinishing);
    }
  }
}

// Worker a is lost, and its band is leased to b. Then a returns with wrong pixels of this band, and
// c has to decide.
TEST(Audit, ALateResultThatDiffersOpensADispute) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{16}, 8, 1));
  farm.hello(1, "a", 1);
  const auto first = farm.all<action::Lease>();
  farm.send(input::SessionEnded{1, "connection reset"});
  farm.hello(2, "b", 1);
  farm.stored(first[0], "b");
  farm.hello(3, "a", 1);
  farm.hello(4, "c", 1);
  input::BandStored wrong;
  wrong.job = job;
  wrong.band = first[0].band;
  wrong.row_digests = {42};
  wrong.instance = "a";
  wrong.written = false;
  farm.send(wrong);
  for (const auto& lease : farm.all<action::Lease>()) {
    if (lease.audit) {
      EXPECT_EQ(lease.session, 4u);
      farm.stored(lease, "c");
    }
  }
  ASSERT_EQ(farm.all_records<record::WorkerQuarantined>().size(), 1u);
  EXPECT_EQ(farm.all_records<record::WorkerQuarantined>()[0].name, "worker-a");
  EXPECT_EQ(farm.all<action::Close>().back().session, 3u);
}

TEST(Audit, AFailedAuditDoesNotFailTheJob) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  farm.result(farm.lease(1, false), "a");
  farm.send(input::BandFailed{2, farm.lease(2, true).lease, "out of memory", {}});
  farm.pass_time(0.5, {1, 2});
  EXPECT_EQ(farm.job(1).state, JobState::kFinishing) << "no other machine is left";
}

TEST(Quarantine, LastsOverRestartsUntilItIsLifted) {
  AuditFarm farm = two_results(7, 0);
  farm.result(farm.lease(1, true), "a", 8);
  AuditFarm next;
  for (const Record& record : farm.scheduler.snapshot()) {
    next.scheduler.replay(record);
  }
  input::BandStored old;
  old.job = 1;
  old.band = farm.lease(1, false).band;
  old.row_digests = {42};
  old.process = worker_process_id("a");
  next.scheduler.replay(old);
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(next.job(1).samples_done, 0u) << "the rows of a quarantined worker stay void";
  EXPECT_EQ(next.state_of("worker-a"), "quarantined");
  // The same process and a new process on the same machine are both refused.
  EXPECT_EQ(in<action::Refuse>(next.hello(1, "a")).size(), 1u);
  WorkerHello again;
  again.instance = "a2";
  again.name = "worker-a";
  again.protocol = 1;
  again.pixel_version = 2;
  again.canary = 3;
  const auto refused = in<action::Refuse>(next.send(input::Hello{2, again}));
  ASSERT_EQ(refused.size(), 1u);
  EXPECT_NE(refused[0].reason.find("bandsaw quarantine --lift worker-a"), std::string::npos);
  EXPECT_TRUE(absl::IsNotFound(next.send(input::LiftQuarantine{"nobody"}).status));
  EXPECT_TRUE(next.send(input::LiftQuarantine{"worker-a"}).status.ok());
  EXPECT_EQ(in<action::Welcome>(next.send(input::Hello{3, again})).size(), 1u);
  EXPECT_NE(in<action::Refuse>(next.hello(4, "a"))[0].reason.find("start the worker again"),
            std::string::npos);
}

TEST(Quarantine, IsImposedAgainAfterALift) {
  AuditFarm farm = two_results(7, 0);
  farm.result(farm.lease(1, true), "a", 8);
  ASSERT_TRUE(farm.send(input::LiftQuarantine{"worker-a"}).status.ok());
  ASSERT_TRUE(farm.send(input::Quarantine{"worker-a"}).status.ok());
  ASSERT_TRUE(farm.send(input::Quarantine{"worker-a"}).status.ok());
  EXPECT_EQ(farm.all_records<record::WorkerQuarantined>().size(), 2u)
      << "a repeated request must add no record";
  WorkerHello again = test_worker("a2");
  again.name = "worker-a";
  EXPECT_EQ(in<action::Refuse>(farm.send(input::Hello{3, again})).size(), 1u);
  AuditFarm next;
  for (const Record& record : farm.scheduler.snapshot()) {
    next.scheduler.replay(record);
  }
  next.take(next.scheduler.replayed(next.now));
  EXPECT_EQ(in<action::Refuse>(next.send(input::Hello{3, again})).size(), 1u);
}

TEST(Audit, AuditsTheRowsThatReplaceRetractedOnes) {
  AuditFarm farm = two_results(0, 0);
  farm.submit(test_job("r2", StopAtSamples{8}, 8, 2));
  farm.hello(3, "c", 1);
  farm.result(farm.lease(1, false), "a");
  farm.send(input::Quarantine{"worker-a"});
  const auto audits = farm.all_records<record::BandAudited>();
  for (std::size_t i = 0; i < farm.all<action::Lease>().size(); ++i) {
    const action::Lease lease = farm.all<action::Lease>()[i];
    if (lease.job == 2 && lease.session != 1) {
      farm.result(lease, lease.session == 2 ? "b" : "c");
    }
  }
  EXPECT_EQ(farm.job(2).state, JobState::kFinishing);
  EXPECT_EQ(farm.all_records<record::BandAudited>().size(), audits.size() + 2)
      << "both rows must be audited";
}

TEST(Audit, ALargeBandIsComparedInPartsAndNoPartTwice) {
  SchedulerOptions options = audited();
  options.band_target_s = 1;
  AuditFarm farm(options);
  farm.submit(test_job("r1", StopAtSamples{8}));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  input::BandStored slow;
  slow.job = 1;
  slow.band = farm.lease(1, false).band;
  ASSERT_GT(slow.band.rows.count(), 1u);
  slow.row_digests = honest_digests(slow.band);
  slow.instance = "a";
  slow.render_s = 100;  // more than was predicted
  farm.send(slow);
  const action::Lease part = farm.lease(2, true);
  EXPECT_LT(part.band.rows.count(), slow.band.rows.count());
  farm.result(part, "b");
  EXPECT_EQ(farm.lease(2, true).band.rows.first, part.band.rows.last);
  EXPECT_EQ(farm.job(1).bands_audited, 1u);

  FarmDriver next(options);
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  slow.instance.clear();
  slow.process = worker_process_id("a");
  next.scheduler.replay(slow);
  next.take(next.scheduler.replayed(next.now));
  next.hello(1, "a", 1);
  next.hello(2, "b", 1);
  next.pass_time(60, {1, 2});  // the grace time for other workers is over
  std::optional<RowRange> again;
  for (const action::Lease& lease : next.all<action::Lease>()) {
    again = lease.audit && !again ? std::optional(lease.band.rows) : again;
  }
  ASSERT_TRUE(again);
  EXPECT_EQ(again->first, part.band.rows.last) << "the first part was compared before the restart";
}

TEST(Audit, DecidesNothingOnceTheImageIsRequested) {
  AuditFarm farm(test_options());
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  const action::Lease lease = farm.all<action::Lease>()[0];
  farm.result(lease, lease.session == 1 ? "a" : "b");
  ASSERT_EQ(farm.job(1).state, JobState::kFinishing);
  farm.send(input::Quarantine{"worker-a"});
  farm.send(input::Quarantine{"worker-b"});
  farm.hello(3, "c", 1);
  farm.result(lease, "c", 5);  // late, and different
  farm.send(input::StorageFailed{1, "the disk is full"});
  farm.send(input::StorageBack{});
  farm.send(input::ResultWritten{1});
  EXPECT_EQ(farm.job(1).state, JobState::kDone);
}

TEST(Quarantine, ForgetsAnErrorMeasuredWithWrongPixels) {
  AuditFarm farm;
  farm.submit(test_job("r1", StopAtError{.relative_rmse = 0.01}, 8, 1));
  farm.hello(1, "a", 1);
  farm.hello(2, "b", 1);
  farm.hello(3, "c", 1);
  const std::string who[] = {"", "a", "b", "c"};
  for (std::size_t i = 0; i < 40 && farm.all<action::Retract>().empty(); ++i) {
    const action::Lease lease = farm.all<action::Lease>().at(i);
    farm.result(lease, who[lease.session], lease.session == 1 ? 7 : 0);
    if (farm.all<action::Retract>().empty()) {
      farm.send(input::PassMerged{1, 8 * (i + 1), ErrorEstimate{.relative_rmse = 1e-6}});
      EXPECT_EQ(farm.job(1).error, 1e-6);
      // The error is far below the target, but it is compared only when all audits are done.
      EXPECT_EQ(farm.job(1).state, JobState::kRunning) << "the job must not end before its audits";
    }
  }
  ASSERT_FALSE(farm.all<action::Retract>().empty());
  EXPECT_LT(farm.job(1).error, 0);  // unknown
  EXPECT_TRUE(farm.job(1).curve.empty());
  EXPECT_EQ(farm.job(1).state, JobState::kRunning);
}

}  // namespace
}  // namespace bandsaw::coordinator
