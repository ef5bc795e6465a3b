// Delivery of a job's states to its watchers. A watcher gets at least one and at most ten states a
// second, and it always gets the final state.

#include "coordinator/engine/watchers.h"

#include <gtest/gtest.h>

namespace bandsaw::coordinator {
namespace {

class WatchersTest : public testing::Test {
 protected:
  /// Adds a watcher that ends its watch after `times` states. States are collected in `told_`.
  void watch(int times = 1'000'000) {
    watchers_.add(
        1, view_,
        [this, times](absl::StatusOr<JobView> view) {
          told_.push_back(std::move(view));
          return std::ssize(told_) < times;
        },
        now_);
  }
  /// Runs `count` steps of a hundredth of a second. `news`: the job changes in each step.
  /// `hold_final`: the final state of the job is not durable yet.
  void pass(int count, bool news, bool hold_final = false) {
    for (int i = 0; i < count; ++i) {
      now_ += 0.01;
      view_.samples_done += news ? 1 : 0;
      view_.elapsed_s = now_;
      watchers_.update([this](JobId) { return std::optional(view_); }, hold_final, now_);
    }
  }
  JobView view_{.id = 1,
                .spec = {},
                .reason = {},
                .counters = {},
                .log_of = {},
                .log = {},
                .workers = {},
                .curve = {},
                .shares = {},
                .frames = {}};
  Time now_ = 50;
  Watchers watchers_;
  std::vector<absl::StatusOr<JobView>> told_;
};

TEST_F(WatchersTest, ThePresentStateIsDeliveredAtOnce) {
  watch();
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(WatchersTest, ChangesAreDeliveredAtMostTenTimesASecond) {
  watch();
  pass(1000, /*news=*/true);
  // A thousand steps are ten seconds. The first state was delivered by watch(), before the steps.
  EXPECT_LE(told_.size(), 101u);
  EXPECT_GE(told_.size(), 80u);
  EXPECT_GE(told_.back()->samples_done, 980u);
}

TEST_F(WatchersTest, AnUnchangedStateIsDeliveredOnceASecond) {
  watch();
  pass(1000, /*news=*/false);
  EXPECT_GE(told_.size(), 11u);
  EXPECT_LE(told_.size(), 13u);
}

TEST_F(WatchersTest, TheFinalStateIsAlwaysDeliveredAndIsTheLast) {
  watch();
  pass(3, /*news=*/true);
  view_.state = JobState::kDone;
  pass(100, /*news=*/true);
  EXPECT_EQ(told_.back()->state, JobState::kDone);
  EXPECT_EQ(told_.size(), 2u);
}

TEST_F(WatchersTest, AFinalStateIsNotDeliveredBeforeItIsDurable) {
  watch();
  view_.state = JobState::kDone;
  pass(100, /*news=*/false, /*hold_final=*/true);
  EXPECT_EQ(told_.size(), 1u);
  pass(100, /*news=*/false);
  EXPECT_EQ(told_.size(), 2u);
}

TEST_F(WatchersTest, WatchingAFinalJobEndsWithItsState) {
  view_.state = JobState::kCancelled;
  watch();
  pass(200, /*news=*/true);
  EXPECT_EQ(told_.size(), 1u);
}

TEST_F(WatchersTest, AJobThatIsForgottenEndsTheWatch) {
  watch();
  for (int i = 0; i < 50; ++i) {
    now_ += 0.01;
    watchers_.update([](JobId) { return std::nullopt; }, /*hold_final=*/false, now_);
  }
  ASSERT_EQ(told_.size(), 2u);
  EXPECT_EQ(told_[1].status().code(), absl::StatusCode::kNotFound);
}

TEST_F(WatchersTest, AWatcherThatReturnsFalseIsRemoved) {
  watch(2);
  watch();
  pass(50, /*news=*/true);
  EXPECT_GE(told_.size(), 5u);
  const std::size_t before = told_.size();
  pass(11, /*news=*/true);  // long enough for one delivery, or two
  EXPECT_LE(told_.size() - before, 2u) << "only one watcher must be left";
}

TEST_F(WatchersTest, AnUnknownJobIsNotFound) {
  watchers_.add(
      9, std::nullopt,
      [this](absl::StatusOr<JobView> view) {
        told_.push_back(std::move(view));
        return true;
      },
      now_);
  ASSERT_EQ(told_.size(), 1u);
  EXPECT_EQ(told_[0].status().code(), absl::StatusCode::kNotFound);
}

}  // namespace
}  // namespace bandsaw::coordinator
