// Tests the queue of tasks for one thread (Mailbox), the callback that is called exactly once
// (Answer), and the limit of the memory for images (MemoryBudget). A Mailbox takes a function,
// which it calls after each batch of tasks, and the longest time between two calls of this
// function. An Answer that is destroyed without a call gives the status UNAVAILABLE.

#include "coordinator/engine/mailbox.h"

#include <gtest/gtest.h>

#include <atomic>

#include "coordinator/engine/answer.h"
#include "coordinator/engine/incoming_band.h"
#include "tests/unit/engine/box.h"

namespace bandsaw::coordinator {
namespace {

using std::chrono::milliseconds;

TEST(Mailbox, DoesTasksInOrderOnOneThread) {
  Box<std::vector<int>> box;
  std::vector<int> done;
  Mailbox mailbox([&] { box.put(done); }, milliseconds(1000));
  for (int i = 0; i < 50; ++i) {
    mailbox.post([&done, i] { done.push_back(i); });
  }
  mailbox.start();
  for (int i = 50; i < 100; ++i) {
    mailbox.post([&done, i] { done.push_back(i); });
  }
  const auto all = box.wait([](const std::vector<int>& d) { return d.size() == 100; });
  EXPECT_TRUE(std::is_sorted(all.begin(), all.end()));
}

TEST(Mailbox, CallsItsFunctionAlsoWithoutTasks) {
  std::atomic<int> runs{0};
  Box<int> box;
  Mailbox mailbox([&] { box.put(++runs); }, milliseconds(1));
  mailbox.start();
  box.wait([](int n) { return n >= 3; });
}

TEST(Mailbox, StopAnswersWaitingTasksWithUnavailable) {
  Box<absl::Status> box;
  const auto answer = [&] {
    return Answer<int>([&](absl::StatusOr<int> value) { box.put(value.status()); });
  };
  Mailbox mailbox([] {}, milliseconds(1));
  mailbox.post([a = answer()]() mutable { a(1); });
  mailbox.stop();
  EXPECT_EQ(box.take().code(), absl::StatusCode::kUnavailable);
  box.put(absl::OkStatus());  // stays in the box if the next task is not answered
  mailbox.post([a = answer()]() mutable { a(1); });
  EXPECT_EQ(box.take().code(), absl::StatusCode::kUnavailable)
      << "a task that is posted after the stop must be answered, too";
}

TEST(Answer, IsCalledOnce) {
  int calls = 0;
  {
    Answer<int> answer([&](absl::StatusOr<int> value) { calls += value.ok() ? 1 : 100; });
    Answer<int> moved = std::move(answer);
    moved(1);
    moved(2);
  }
  EXPECT_EQ(calls, 1);
}

TEST(MemoryBudget, IsReturnedWhenAShareEnds) {
  MemoryBudget budget(100);
  std::optional<MemoryBudget::Share> most = budget.take(80);
  ASSERT_TRUE(most);
  EXPECT_FALSE(budget.take(30));
  EXPECT_TRUE(budget.take(20));
  MemoryBudget::Share moved = *std::move(most);
  most.reset();
  EXPECT_FALSE(budget.take(30)) << "a share that was moved must keep its bytes";
  moved = {};
  EXPECT_TRUE(budget.take(100));
}

TEST(MemoryBudget, FollowsTheSizeOfAShare) {
  MemoryBudget budget(100);
  std::optional<MemoryBudget::Share> share = budget.take(80);
  ASSERT_TRUE(share);
  share->resize(30);
  EXPECT_EQ(budget.left(), 70);
  share->resize(120);
  EXPECT_FALSE(budget.take(1));
  MemoryBudget::Share().resize(50);  // a share without a budget
  share.reset();
  EXPECT_EQ(budget.left(), 100);
}

}  // namespace
}  // namespace bandsaw::coordinator
