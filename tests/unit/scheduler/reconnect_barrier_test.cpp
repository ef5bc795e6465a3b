// The reconnect barrier. If the coordinator's own network fails, all workers fall silent at once
// and reconnect one by one. The rows that are free then may have been rendered by a worker that is
// not back yet. So after the first of these workers has come back, no new lease is granted until
// all are back, or until 6 s (the grace time) have passed.

#include "farm_driver.h"

namespace bandsaw::coordinator {
namespace {

bool share_rows(const action::Lease& one, const action::Lease& other) {
  return one.band.rows.first < other.band.rows.last && other.band.rows.first < one.band.rows.last;
}

/// Two workers that fall silent together, each with a lease.
struct AllLost {
  FarmDriver farm{slow()};
  JobId job = farm.submit(test_job("r1", StopAtSamples{8}, 8, 32));
  std::vector<action::Lease> leases;

  AllLost() {
    farm.hello(1, "a", 1);
    farm.hello(2, "b", 1);
    leases = farm.all<action::Lease>();
    farm.pass_time(6);  // workers are disconnected after 4 s of silence
    farm.actions.clear();
  }

  /// Returns the entry of a lease in the Hello of the worker that holds it. "one" is the epoch, the
  /// coordinator's only run.
  WorkerHello::Held held(std::size_t lease, bool finished) const {
    return {job, leases.at(lease).band, leases.at(lease).lease, "one", finished};
  }
};

TEST(ReconnectBarrier, TheFirstReconnectedWorkerGetsNoRowsThatAnotherHasRendered) {
  AllLost all;
  ASSERT_EQ(all.leases.size(), 2u);
  all.farm.stored(all.leases[0], "a");
  all.farm.hello(3, "a", 1);
  EXPECT_TRUE(all.farm.all<action::Lease>().empty());
  EXPECT_NE(all.farm.job(all.job).reason.find("waits for 1 workers"), std::string::npos);
  const Step step = all.farm.hello(4, "b", 1, {all.held(1, /*finished=*/true)});
  const auto given = in<action::Lease>(step);
  ASSERT_EQ(given.size(), 2u) << "b gets its own lease again, and a gets new rows";
  EXPECT_EQ(given[0].lease, all.leases[1].lease);
  EXPECT_FALSE(share_rows(given[1], all.leases[1]));
}

TEST(ReconnectBarrier, EndsAfterTheGraceTime) {
  AllLost all;
  all.farm.pass_time(3600);  // not counted: the grace time begins when a worker is back
  all.farm.stored(all.leases[0], "a");
  all.farm.hello(3, "a", 1);
  all.farm.pass_time(5, {3});
  EXPECT_TRUE(all.farm.all<action::Lease>().empty());
  all.farm.pass_time(2, {3});
  ASSERT_EQ(all.farm.all<action::Lease>().size(), 1u);
  EXPECT_TRUE(share_rows(all.farm.all<action::Lease>()[0], all.leases[1]));
}

// None of the lost workers is back, so the barrier has not begun.
TEST(ReconnectBarrier, ANewWorkerGetsWorkAtOnce) {
  AllLost all;
  all.farm.hello(3, "c", 1);
  EXPECT_EQ(all.farm.all<action::Lease>().size(), 1u);
}

// The connection of a killed worker ends at once. The barrier waits only for workers that fell
// silent.
TEST(ReconnectBarrier, DoesNotWaitForWorkersThatWereKilled) {
  FarmDriver farm{slow()};
  farm.submit(test_job("r1", StopAtSamples{8}, 8, 32));
  for (const SessionId session : {1u, 2u}) {
    farm.hello(session, std::to_string(session), 1);
  }
  for (const SessionId session : {1u, 2u}) {
    farm.send(input::SessionEnded{session, "connection reset"});
  }
  farm.actions.clear();
  farm.hello(3, "1", 1);
  EXPECT_EQ(farm.all<action::Lease>().size(), 1u);
}

}  // namespace
}  // namespace bandsaw::coordinator
