// PoolWatch reports the progress of a pool of threads while another thread waits for the pool. A
// range is all the calls of one parallel_for().

#include "worker/executor/pool_watch.h"

#include <gtest/gtest.h>

#include <atomic>

namespace bandsaw::worker {
namespace {

constexpr std::chrono::milliseconds kInterval{1};

// The second call waits until the first one has been reported, so this test ends only if a report
// comes while the range is running.
TEST(PoolWatch, ReportsCallsThatAreCompletedWhileTheRangeIsRunning) {
  Pool pool(1);
  std::atomic<bool> reported = false;
  PoolWatch watch(pool, kInterval, [&] {
    reported = true;
    reported.notify_all();
  });
  pool.parallel_for(2, [&](std::int64_t i) {
    if (i == 1) {
      reported.wait(false);
    }
  });
  EXPECT_TRUE(reported);
}

TEST(PoolWatch, ReportsNothingWhileNoCallIsCompleted) {
  Pool pool(1);
  pool.parallel_for(5, [](std::int64_t) {});  // before the watch begins
  std::atomic<int> reports = 0;
  {
    PoolWatch watch(pool, kInterval, [&] { ++reports; });
    PoolWatch other(pool, kInterval, [] {});  // takes some intervals to begin and to end
  }
  EXPECT_EQ(reports, 0);
}

TEST(PoolWatch, EndsDuringALongInterval) {
  Pool pool(1);
  const PoolWatch watch(pool, std::chrono::hours(10), [] {});
}

}  // namespace
}  // namespace bandsaw::worker
