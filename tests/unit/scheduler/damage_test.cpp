// A stored band that is found damaged on disk becomes free again. It is rendered again, and is
// counted once. If the band was audited (rendered by a second worker and compared), it is audited
// again.

#include "coordinator/scheduler/api/worker_process.h"
#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

/// Returns options with which all bands are audited.
SchedulerOptions with_audits() {
  SchedulerOptions options = test_options();
  options.audit_share = 1;
  return options;
}

/// Reports that the record of this band, rendered by this instance, is damaged.
Step lose(FarmDriver& farm, JobId job, const Band& band, const std::string& instance) {
  return farm.send(input::BandsDamaged{
      .job = job, .bands = {{.band = band, .process = worker_process_id(instance)}}});
}

TEST(Damage, ADamagedBandIsFreeAgainAndCountedOnce) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>().at(0);
  farm.stored(lease, "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  const std::uint64_t rays = farm.job(job).counters.rays;
  const Step step = lose(farm, job, lease.band, "a");
  EXPECT_EQ(farm.job(job).state, JobState::kRunning);
  EXPECT_EQ(farm.job(job).samples_done, 0u);
  EXPECT_NE(farm.scheduler.why(job, farm.now).back().find("damaged"), std::string::npos);
  const auto again = in<action::Lease>(step);
  ASSERT_EQ(again.size(), 1u);
  EXPECT_EQ(again[0].band, lease.band);
  ASSERT_EQ(farm.all_records<record::BandLost>().size(), 1u);
  farm.stored(again[0], "a");
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  EXPECT_EQ(farm.all<action::WriteResult>().size(), 2u) << "the image must be requested again";
  EXPECT_EQ(farm.job(job).samples_done, 8u * 8);
  EXPECT_EQ(farm.job(job).counters.rays, rays);
}

TEST(Damage, ReportsOfBandsThatWereNotStoredChangeNothing) {
  FarmDriver farm;
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>().at(0);
  farm.stored(lease, "a");
  lose(farm, job, lease.band, "b");                    // "b" has stored nothing
  lose(farm, job, {lease.band.samples, {0, 2}}, "a");  // the stored band has one row
  lose(farm, job + 1, lease.band, "a");                // an unknown job
  EXPECT_EQ(farm.job(job).samples_done, 8u * 8);
  EXPECT_EQ(farm.job(job).state, JobState::kFinishing);
  EXPECT_TRUE(farm.all_records<record::BandLost>().empty());
}

/// Lets worker "a" store the only band, and lets worker "b" audit it with the same result. Returns
/// the lease of worker "a".
action::Lease store_and_audit(FarmDriver& farm) {
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>().at(0);
  farm.hello(2, "b");
  farm.stored(lease, "a");
  farm.stored(farm.all<action::Lease>().back(), "b");
  EXPECT_EQ(farm.all_records<record::BandAudited>().size(), 1u);
  return lease;
}

TEST(Damage, RowsThatAreRenderedAgainAreAuditedAgain) {
  FarmDriver farm(with_audits());
  const action::Lease lease = store_and_audit(farm);
  farm.actions.clear();
  lose(farm, lease.job, lease.band, "a");
  EXPECT_EQ(farm.job(lease.job).bands_audited, 0u);
  farm.stored(lease, "a");
  const auto leases = farm.all<action::Lease>();
  EXPECT_TRUE(
      std::any_of(leases.begin(), leases.end(), [](const action::Lease& l) { return l.audit; }));
  EXPECT_EQ(farm.job(lease.job).state, JobState::kRunning);
}

TEST(Damage, ARestartNotesAuditedBandsMissingFromTheLog) {
  FarmDriver farm(with_audits());
  const action::Lease lease = store_and_audit(farm);
  FarmDriver next(with_audits());
  for (const Record& record : farm.records) {
    next.scheduler.replay(record);
  }
  // The audited band is not replayed: the band log has only 100 bytes, which form no whole band.
  next.scheduler.replay_damage(lease.job, 100);
  next.take(next.scheduler.replayed(next.now));
  ASSERT_EQ(next.all_records<record::BandLost>().size(), 1u);
  EXPECT_EQ(next.job(lease.job).bands_audited, 0u);
  EXPECT_EQ(next.job(lease.job).state, JobState::kRunning);
  EXPECT_NE(next.scheduler.why(lease.job, next.now).back().find("100 bytes"), std::string::npos);
}

TEST(Damage, TheAuditOfALostBandIsRevoked) {
  FarmDriver farm(with_audits());
  const JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
  farm.hello(1, "a");
  const action::Lease lease = farm.all<action::Lease>().at(0);
  farm.hello(2, "b");
  farm.stored(lease, "a");
  const action::Lease audit = farm.all<action::Lease>().back();
  ASSERT_TRUE(audit.audit);
  const auto revoked = in<action::Revoke>(lose(farm, job, lease.band, "a"));
  ASSERT_FALSE(revoked.empty());
  EXPECT_EQ(revoked[0].leases, std::vector<LeaseId>{audit.lease});
}

}  // namespace
}  // namespace bandsaw::coordinator
