// Effects of the scheduler, such as an answer to a user, wait until the journal has their records
// on disk.

#include "coordinator/engine/commit_queue.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/engine/fakes.h"

namespace bandsaw::coordinator {
namespace {

/// An effect is done only after all records that were added before the effect are on disk. A
/// completion is also called if the records could not be written. The argument of a completion is
/// the status of the journal. In these tests, effects and completions append their names to
/// `done_`. A completion whose status is an error appends "!" before its name.
class CommitQueueTest : public testing::Test {
 protected:
  void effect(const std::string& name) {
    commit_queue_.effect([this, name] {
      done_ += name;
      records_when_done_ = disk_->records().size();
    });
  }
  void completion(const std::string& name) {
    commit_queue_.completion(
        [this, name](const absl::Status& s) { done_ += s.ok() ? name : "!" + name; });
  }
  std::shared_ptr<JournalDisk> disk_ = std::make_shared<JournalDisk>();
  MemoryJournal journal_{disk_};
  CommitQueue commit_queue_{journal_};
  std::string done_;
  std::size_t records_when_done_ = 0;
};

TEST_F(CommitQueueTest, AnEffectWaitsUntilItsRecordsAreDurable) {
  commit_queue_.record(record::WorkerJoined{"a"});
  effect("a");
  commit_queue_.record(record::WorkerJoined{"b"});
  completion("b");
  EXPECT_EQ(done_, "");
  ASSERT_TRUE(commit_queue_.flush().ok());
  EXPECT_EQ(done_, "ab");
  EXPECT_EQ(records_when_done_, 2u);
}

TEST_F(CommitQueueTest, AFailedJournalFailsCompletionsAndKeepsEffectsInOrder) {
  disk_->break_it();
  commit_queue_.record(record::WorkerJoined{"a"});
  effect("a");
  completion("b");
  effect("c");
  EXPECT_EQ(commit_queue_.flush().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(done_, "!b");
  effect("d");
  disk_->mend();
  ASSERT_TRUE(commit_queue_.flush().ok());
  EXPECT_EQ(done_, "!bacd");
  EXPECT_EQ(disk_->records().size(), 1u);
}

TEST_F(CommitQueueTest, RecordsAndEffectsThatAnEffectAddsWaitForTheNextFlush) {
  commit_queue_.effect([this] {
    commit_queue_.record(record::WorkerLeft{"a"});
    effect("late");
  });
  ASSERT_TRUE(commit_queue_.flush().ok());
  EXPECT_EQ(done_, "");
  ASSERT_TRUE(commit_queue_.flush().ok());
  EXPECT_EQ(done_, "late");
}

}  // namespace
}  // namespace bandsaw::coordinator
