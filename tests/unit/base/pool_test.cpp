// Tests the thread pool. parallel_for() calls the function once for each index, also if several
// threads call parallel_for() at once. It throws the exception that a call of the function throws.

#include "renderlib/base/pool.h"

#include <gtest/gtest.h>

#include <atomic>
#include <new>
#include <numeric>
#include <thread>
#include <vector>

namespace bandsaw {
namespace {

TEST(Pool, CallsEachIndexOnce) {
  Pool pool(3);
  std::vector<std::atomic<int>> calls(1000);
  pool.parallel_for(1000, [&](std::int64_t i) { ++calls[static_cast<std::size_t>(i)]; });
  for (const std::atomic<int>& count : calls) {
    EXPECT_EQ(count, 1);
  }
}

TEST(Pool, CountsTheCallsThatHaveReturned) {
  Pool pool(3);
  EXPECT_EQ(pool.calls_done(), 0u);
  pool.parallel_for(100, [](std::int64_t) {});
  pool.parallel_for(7, [](std::int64_t) {});
  EXPECT_EQ(pool.calls_done(), 107u);
}

TEST(Pool, MakesNoCallForAnEmptyRange) {
  Pool pool(1);
  pool.parallel_for(0, [](std::int64_t) { FAIL(); });
  pool.parallel_for(-3, [](std::int64_t) { FAIL(); });
}

TEST(Pool, RunsRangesOfSeveralCallersAtOnce) {
  Pool pool(2);
  std::atomic<int> sum = 0;
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 4; ++caller) {
    callers.emplace_back([&] {
      for (int round = 0; round < 50; ++round) {
        pool.parallel_for(7, [&](std::int64_t i) { sum += static_cast<int>(i); });
      }
    });
  }
  for (std::thread& caller : callers) {
    caller.join();
  }
  EXPECT_EQ(sum, 4 * 50 * 21);  // 21 is the sum of the indices 0 to 6
}

TEST(Pool, FinishesOneRangeWhileAnotherIsHeldUp) {
  Pool pool(2);
  std::atomic<bool> release = false;
  std::atomic<bool> held = false;
  std::thread slow([&] {
    pool.parallel_for(1, [&](std::int64_t) {
      held = true;
      held.notify_all();
      release.wait(false);
    });
  });
  held.wait(false);
  int done = 0;
  pool.parallel_for(10, [&](std::int64_t) { ++done; });  // run by the one thread that is free
  EXPECT_EQ(done, 10);
  release = true;
  release.notify_all();
  slow.join();
}

TEST(Pool, ThrowsTheExceptionOfACall) {
  Pool pool(3);
  std::vector<std::atomic<int>> calls(1000);
  const auto body = [&](std::int64_t i) {
    ++calls[static_cast<std::size_t>(i)];
    if (i == 5) {
      throw std::bad_alloc();
    }
  };
  EXPECT_THROW(pool.parallel_for(1000, body), std::bad_alloc);
  for (const std::atomic<int>& count : calls) {
    EXPECT_LE(count, 1);
  }
  std::atomic<int> sum = 0;
  pool.parallel_for(7, [&](std::int64_t i) { sum += static_cast<int>(i); });
  EXPECT_EQ(sum, 21) << "the pool must still work after an exception";
}

TEST(Pool, ThrowsOnceIfEveryCallThrows) {
  Pool pool(3);
  for (int round = 0; round < 100; ++round) {
    EXPECT_THROW(pool.parallel_for(7, [](std::int64_t) { throw std::bad_alloc(); }),
                 std::bad_alloc);
  }
}

TEST(Pool, MakesNoFurtherCallsAfterAnException) {
  Pool pool(1);
  int calls = 0;
  const auto body = [&](std::int64_t i) {
    ++calls;
    if (i == 2) {
      throw std::bad_alloc();
    }
  };
  EXPECT_THROW(pool.parallel_for(10, body), std::bad_alloc);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace bandsaw
