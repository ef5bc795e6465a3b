#include "coordinator/engine/outbox.h"

#include <gtest/gtest.h>

#include <string>

#include "tests/unit/engine/fakes.h"

namespace bandsaw::coordinator {
namespace {

class OutboxTest : public testing::Test {
 protected:
  void deed(const std::string& name) {
    outbox_.deed([this, name] {
      done_ += name;
      records_when_done_ = disk_->records().size();
    });
  }
  void reply(const std::string& name) {
    outbox_.reply([this, name](const absl::Status& s) { done_ += s.ok() ? name : "!" + name; });
  }
  std::shared_ptr<JournalDisk> disk_ = std::make_shared<JournalDisk>();
  MemoryJournal journal_{disk_};
  Outbox outbox_{journal_};
  std::string done_;
  std::size_t records_when_done_ = 0;
};

TEST_F(OutboxTest, NothingHappensBeforeItsRecordsAreDurable) {
  outbox_.record(record::WorkerJoined{"a"});
  deed("a");
  outbox_.record(record::WorkerJoined{"b"});
  reply("b");
  EXPECT_EQ(done_, "");
  ASSERT_TRUE(outbox_.flush().ok());
  EXPECT_EQ(done_, "ab");
  EXPECT_EQ(records_when_done_, 2u);
}

TEST_F(OutboxTest, WhenTheJournalFailsRepliesSaySoAndDeedsWaitInOrder) {
  disk_->break_it();
  outbox_.record(record::WorkerJoined{"a"});
  deed("a");
  reply("b");
  deed("c");
  EXPECT_EQ(outbox_.flush().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(done_, "!b");
  deed("d");
  disk_->mend();
  ASSERT_TRUE(outbox_.flush().ok());
  EXPECT_EQ(done_, "!bacd");
  EXPECT_EQ(disk_->records().size(), 1u);
}

TEST_F(OutboxTest, WhatADeedAddsWaitsForTheNextFlush) {
  outbox_.deed([this] {
    outbox_.record(record::WorkerLeft{"a"});
    deed("late");
  });
  ASSERT_TRUE(outbox_.flush().ok());
  EXPECT_EQ(done_, "");
  ASSERT_TRUE(outbox_.flush().ok());
  EXPECT_EQ(done_, "late");
}

}  // namespace
}  // namespace bandsaw::coordinator
