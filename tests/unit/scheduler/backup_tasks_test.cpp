// Work for an idle worker when no band is free: it steals a lease that another worker has not
// begun, or it gets a backup task, a second lease of a band that is late. The first result ends the
// other lease. Also tests CostMap, which estimates the cost of rows.

#include "coordinator/scheduler/model/row_costs.h"
#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

/// A job of one row, for which the first worker needs so long that the second worker gets a backup
/// task.
struct OneRow {
  OneRow() {
    job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 1));
    farm.hello(1, "a");
    farm.hello(2, "b");
    original = farm.all<action::Lease>().at(0);
    farm.pass_time(2, {1, 2});
    copy = farm.all<action::Lease>().back();
  }
  FarmDriver farm;
  JobId job = 0;
  action::Lease original;
  action::Lease copy;  ///< the backup task
};

TEST(BackupTasks, AnIdleWorkerBacksUpASlowOne) {
  OneRow one;
  ASSERT_EQ(one.farm.all<action::Lease>().size(), 2u);
  EXPECT_EQ(one.copy.session, 2u);
  EXPECT_EQ(one.copy.band, one.original.band);
  EXPECT_TRUE(one.farm.all<action::Revoke>().empty());
  ASSERT_EQ(one.farm.all<action::LogReassignment>().size(), 1u);
  EXPECT_TRUE(one.farm.all<action::LogReassignment>()[0].begun);
}

TEST(BackupTasks, TheBackupsResultCountsAndEndsTheOriginal) {
  OneRow one;
  const Step step = one.farm.stored(one.copy, "b");
  const auto revoked = in<action::Revoke>(step);
  ASSERT_EQ(revoked.size(), 1u);
  EXPECT_EQ(revoked[0].session, 1u);
  EXPECT_EQ(revoked[0].leases, std::vector<LeaseId>{one.original.lease});
  EXPECT_EQ(one.farm.job(one.job).state, JobState::kFinishing);
  EXPECT_TRUE(in<action::AddToFilm>(one.farm.stored(one.original, "a")).empty());
}

TEST(BackupTasks, TheOriginalsResultCountsAndEndsTheBackup) {
  OneRow one;
  const Step step = one.farm.stored(one.original, "a");
  const auto revoked = in<action::Revoke>(step);
  ASSERT_EQ(revoked.size(), 1u);
  EXPECT_EQ(revoked[0].session, 2u);
  EXPECT_EQ(one.farm.job(one.job).state, JobState::kFinishing);
}

TEST(BackupTasks, ABackupInheritsTheRowsOfALostOriginal) {
  OneRow one;
  const Step step = one.farm.send(input::SessionEnded{1, "connection reset"});
  EXPECT_TRUE(in<action::Lease>(step).empty());
  EXPECT_TRUE(in<action::Revoke>(step).empty());
  one.farm.stored(one.copy, "b");
  EXPECT_EQ(one.farm.job(one.job).state, JobState::kFinishing);
}

TEST(BackupTasks, ALostBackupDoesNotChangeTheOriginal) {
  OneRow one;
  const Step step = one.farm.send(input::SessionEnded{2, "connection reset"});
  EXPECT_TRUE(in<action::Lease>(step).empty());
  one.farm.stored(one.original, "a");
  EXPECT_EQ(one.farm.job(one.job).state, JobState::kFinishing);
}

TEST(BackupTasks, ALongBandIsSplitByRowsOverIdleWorkers) {
  FarmDriver farm;
  farm.submit(test_job("r1", StopAtSamples{8}, 1000, 8));
  farm.hello(1, "a", 1);
  farm.stored(farm.all<action::Lease>()[0], "a", 0.001);  // so fast that the next band is large
  const action::Lease large = farm.all<action::Lease>().back();
  ASSERT_GT(large.band.rows.count(), 2u);
  farm.pass_time(2, {1});
  for (SessionId s = 2; s <= 4; ++s) {
    farm.hello(s, std::to_string(s), 1);
  }
  farm.pass_time(20, {1, 2, 3, 4});
  std::vector<RowRange> rows;
  for (const action::Lease& lease : farm.all<action::Lease>()) {
    if (lease.session > 1 && lease.band.rows.first >= large.band.rows.first) {
      rows.push_back(lease.band.rows);
    }
  }
  ASSERT_FALSE(rows.empty());
  std::sort(rows.begin(), rows.end());
  EXPECT_EQ(rows.front().first, large.band.rows.first);
  EXPECT_EQ(rows.back().last, large.band.rows.last);
}

TEST(BackupTasks, ALeaseThatIsNotBegunIsStolen) {
  SchedulerOptions options = test_options();
  options.band_target_s = 1e-4;  // so short that each band has one row
  FarmDriver farm(options);
  farm.submit(test_job("r1", StopAtSamples{8}, 64, 2));
  farm.hello(1, "a", 2);
  const auto leases = farm.all<action::Lease>();
  ASSERT_EQ(leases.size(), 2u);
  farm.pass_time(3, {1});
  const Step step = farm.hello(2, "b", 1);
  const auto revoked = in<action::Revoke>(step);
  ASSERT_EQ(revoked.size(), 1u);
  EXPECT_EQ(revoked[0].leases, std::vector<LeaseId>{leases[1].lease});
  ASSERT_EQ(in<action::Lease>(step).size(), 1u);
  EXPECT_EQ(in<action::Lease>(step)[0].band, leases[1].band);
  EXPECT_FALSE(in<action::LogReassignment>(step)[0].begun);
}

// The second argument of learn() is the time that the rows took, divided by the predicted time.
// fitting() returns how many of the rows, from the first on, cost at most the given amount
// together. It returns at least 1.
TEST(CostMap, LearnsTheCostOfRows) {
  CostMap cost(200);
  EXPECT_EQ(cost.of_all(), 200);
  // The upper half costs three times as much as was assumed. A single measurement corrects only a
  // part of the difference.
  for (int i = 0; i < 20; ++i) {
    const RowRange top{0, 100};
    cost.learn(top, 300 / cost.of(top));
  }
  EXPECT_NEAR(cost.of({0, 100}), 300, 1);
  EXPECT_EQ(cost.of({100, 200}), 100);
  EXPECT_NEAR(cost.of_all(), 400, 1);
  EXPECT_EQ(cost.fitting({0, 200}, 30.5), 10u);  // each row costs 3
  EXPECT_EQ(cost.fitting({0, 200}, 0), 1u);
  EXPECT_EQ(cost.fitting({150, 200}, 1e9), 50u);
}

}  // namespace
}  // namespace bandsaw::coordinator
