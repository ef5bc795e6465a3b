// The limit on wrong secrets, here 2 a minute: failures are counted by address and minute. The
// second argument of `add` is the time in seconds. The verdict is kFirst for the first failure of a
// minute, kMore for further failures up to the limit, and kTooMany beyond the limit.

#include "coordinator/rpc/failures.h"

#include <gtest/gtest.h>

#include <string>

namespace bandsaw::coordinator {
namespace {

using Verdict = Failures::Verdict;

TEST(Failures, AreCountedByAddressAndMinute) {
  Failures failures(2);
  EXPECT_EQ(failures.add("a", 100), Verdict::kFirst);
  EXPECT_EQ(failures.add("a", 110), Verdict::kMore);
  EXPECT_EQ(failures.add("a", 120), Verdict::kTooMany);
  EXPECT_EQ(failures.add("b", 120), Verdict::kFirst);
  EXPECT_EQ(failures.add("a", 159), Verdict::kTooMany);
  EXPECT_EQ(failures.add("a", 160), Verdict::kFirst)
      << "a minute after the first failure, the count must begin again";
}

// The counts of at most 10,000 addresses are kept. When they are cleared, a new address must still
// be counted from its first failure.
TEST(Failures, TakeBoundedMemoryForAnyNumberOfAddresses) {
  Failures failures(2);
  for (int i = 0; i < 30'000; ++i) {
    EXPECT_EQ(failures.add(std::to_string(i), 0), Verdict::kFirst);
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
