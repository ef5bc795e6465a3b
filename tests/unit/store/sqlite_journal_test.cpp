// The journal in SQLite: order, damage, older schemas, a full disk, and a process that is killed
// while it appends.

#include "coordinator/store/sqlite_journal.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sqlite3.h>
#include <sys/wait.h>
#include <unistd.h>

#include "absl/strings/str_cat.h"
#include "coordinator/store/record_text.h"
#include "tests/support/full_disk.h"
#include "tests/support/temp_dir.h"
#include "tests/unit/store/sample_records.h"
#include "tests/unit/store/test_files.h"

namespace bandsaw::coordinator {
namespace {

using testing::HasSubstr;

using Texts = std::vector<std::string>;

// Records are compared by their texts.
std::string text_of(const Record& record) {
  const RecordText text = to_text(record);
  return absl::StrCat(text.kind, "\n", text.fields);
}

/// Returns the texts of all records of the journal, in order.
Texts replayed(Journal& journal) {
  Texts all;
  const absl::Status status = journal.replay([&](const Record& r) { all.push_back(text_of(r)); });
  EXPECT_TRUE(status.ok()) << status;
  return all;
}

Texts texts(const std::vector<Record>& records) {
  Texts all;
  for (const Record& record : records) {
    all.push_back(text_of(record));
  }
  return all;
}

void run_sql(const std::string& path, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(path.c_str(), &database), SQLITE_OK);
  char* error = nullptr;
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, &error), SQLITE_OK) << error;
  sqlite3_close(database);
}

class SqliteJournalTest : public testing::Test {
 protected:
  std::unique_ptr<SqliteJournal> open() {
    auto journal = SqliteJournal::open(path_);
    EXPECT_TRUE(journal.ok()) << journal.status();
    return journal.ok() ? *std::move(journal) : nullptr;
  }
  test::TempDir folder_;
  std::string path_ = folder_ / "journal.sqlite";
};

TEST_F(SqliteJournalTest, ReturnsRecordsOfEveryKindInOrderAfterReopening) {
  std::vector<Record> records = sample_records();
  const std::vector<Record> more = {records[4], records[0]};
  {
    const auto journal = open();
    ASSERT_TRUE(journal->append(records).ok());
    ASSERT_TRUE(journal->append({}).ok());
    ASSERT_TRUE(journal->append(more).ok());
  }
  records.insert(records.end(), more.begin(), more.end());
  EXPECT_EQ(replayed(*open()), texts(records));
}

TEST_F(SqliteJournalTest, CanBeRewrittenAndContinued) {
  const std::vector<Record> all = sample_records();
  const std::vector<Record> few = {all[3], all[0]};
  {
    const auto journal = open();
    ASSERT_TRUE(journal->append(all).ok());
    EXPECT_EQ(journal->size(), all.size());
    ASSERT_TRUE(journal->rewrite(few).ok());
    EXPECT_EQ(journal->size(), 2u);
    ASSERT_TRUE(journal->append({all[1]}).ok());
  }
  const auto journal = open();
  EXPECT_EQ(journal->size(), 3u);
  EXPECT_EQ(replayed(*journal), texts({all[3], all[0], all[1]}));
}

TEST_F(SqliteJournalTest, ADamagedRecordIsNamed) {
  ASSERT_TRUE(open()->append(sample_records()).ok());
  run_sql(path_, "UPDATE record SET fields = replace(fields, 'job 1', 'job 2') WHERE sequence = 4");
  const absl::Status status = open()->replay([](const Record&) {});
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(status.message()), HasSubstr("record 4"));
}

TEST_F(SqliteJournalTest, AMissingRecordIsNamed) {
  ASSERT_TRUE(open()->append(sample_records()).ok());
  run_sql(path_, "DELETE FROM record WHERE sequence = 2");
  const absl::Status status = open()->replay([](const Record&) {});
  EXPECT_EQ(status.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(status.message()), HasSubstr("record 2"));
}

TEST_F(SqliteJournalTest, AnOldSchemaIsReadAndUpgraded) {
  ASSERT_TRUE(open()->append(sample_records()).ok());
  run_sql(path_, "PRAGMA user_version = 1");
  for (int opening = 0; opening < 2; ++opening) {
    EXPECT_EQ(replayed(*open()), texts(sample_records()));
  }
}

// A sequence is a job of many frames. Journals up to version 8 have no sequences. They can be read,
// and appending a sequence raises their version. The last three sample records belong to a
// sequence.
TEST_F(SqliteJournalTest, ASequenceCanBeAppendedToAJournalOfVersion8) {
  std::vector<Record> records = sample_records();
  std::vector<Record> old(records.begin(), records.end() - 3);
  ASSERT_TRUE(open()->append(old).ok());
  run_sql(path_, "PRAGMA user_version = 8");
  EXPECT_EQ(replayed(*open()), texts(old));
  ASSERT_TRUE(open()->append(absl::MakeConstSpan(records).last(3)).ok());
  EXPECT_EQ(replayed(*open()), texts(records));
}

TEST_F(SqliteJournalTest, AnOldSchemaIsReadOnAFullDiskAndUpgradedLater) {
  const std::vector<Record> records = sample_records();
  ASSERT_TRUE(open()->append(records).ok());
  run_sql(path_, "PRAGMA user_version = 1");
  // Returns the version of the schema in the file.
  const auto version = [this] {
    std::string found;
    sqlite3* database = nullptr;
    EXPECT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
    const auto keep = [](void* to, int, char** values, char**) {
      *static_cast<std::string*>(to) = values[0];
      return 0;
    };
    EXPECT_EQ(sqlite3_exec(database, "PRAGMA user_version", keep, &found, nullptr), SQLITE_OK);
    sqlite3_close(database);
    return found;
  };
  {
    auto full = std::make_unique<test::FullDisk>(0);
    const auto journal = open();
    ASSERT_NE(journal, nullptr);
    EXPECT_EQ(replayed(*journal), texts(records));
    EXPECT_EQ(journal->append(records).code(), absl::StatusCode::kResourceExhausted);
    full.reset();
    ASSERT_TRUE(journal->append({records[3]}).ok());
  }
  EXPECT_NE(version(), "1");
  EXPECT_EQ(replayed(*open()).size(), records.size() + 1);
}

TEST_F(SqliteJournalTest, AnUnknownSchemaIsRefused) {
  open();
  run_sql(path_, "PRAGMA user_version = 99");
  const absl::Status status = SqliteJournal::open(path_).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(status.message()), HasSubstr("99"));
}

TEST_F(SqliteJournalTest, AFileThatIsNotADatabaseIsDataLoss) {
  write_all(path_, std::string(8192, 'x'));
  EXPECT_EQ(SqliteJournal::open(path_).status().code(), absl::StatusCode::kDataLoss);
}

TEST_F(SqliteJournalTest, AFullDiskLosesNothingAndTheSameAppendWorksLater) {
  const std::vector<Record> records = sample_records();
  const auto journal = open();
  ASSERT_TRUE(journal->append(records).ok());
  {
    const test::FullDisk full(0);
    EXPECT_EQ(journal->append(records).code(), absl::StatusCode::kResourceExhausted);
  }
  EXPECT_EQ(replayed(*journal), texts(records));
  ASSERT_TRUE(journal->append({records[3]}).ok());
  Texts expected = texts(records);
  expected.push_back(text_of(records[3]));
  EXPECT_EQ(replayed(*journal), expected);
}

/// Starts a child process that appends without end. The child writes the number of each finished
/// append to a pipe. Sets `acknowledged` to the reading end of the pipe. Returns the child's
/// process id.
pid_t start_appender(const std::string& path, int& acknowledged) {
  int ends[2];
  EXPECT_EQ(::pipe(ends), 0);
  const pid_t child = ::fork();
  if (child == 0) {
    auto journal = SqliteJournal::open(path);
    for (std::uint64_t i = 0; journal.ok(); ++i) {
      const std::vector<Record> batch(1 + i % 5, record::SamplesFixed{.job = i, .samples = i});
      if (!(*journal)->append(batch).ok() || ::write(ends[1], &i, sizeof i) != sizeof i) {
        ::_exit(1);
      }
    }
    ::_exit(1);
  }
  ::close(ends[1]);
  acknowledged = ends[0];
  return child;
}

TEST_F(SqliteJournalTest, AcknowledgedRecordsSurviveAKillInTheMiddleOfAppends) {
  for (const std::uint64_t kill_after : {1u, 7u, 40u}) {
    const std::string path = folder_ / absl::StrCat("killed", kill_after);
    int acknowledged = -1;
    const pid_t child = start_appender(path, acknowledged);
    std::uint64_t last = 0;
    while (last < kill_after && ::read(acknowledged, &last, sizeof last) == sizeof last) {
    }
    ::kill(child, SIGKILL);
    ::waitpid(child, nullptr, 0);
    while (::read(acknowledged, &last, sizeof last) == sizeof last) {
    }
    ::close(acknowledged);
    std::vector<std::uint64_t> count;
    auto journal = SqliteJournal::open(path);
    ASSERT_TRUE(journal.ok()) << journal.status();
    ASSERT_TRUE((*journal)
                    ->replay([&](const Record& r) {
                      const std::uint64_t job = std::get<record::SamplesFixed>(r).job;
                      count.resize(std::max<std::size_t>(count.size(), job + 1));
                      ++count[job];
                    })
                    .ok());
    ASSERT_GT(count.size(), last);
    for (std::uint64_t i = 0; i < count.size(); ++i) {
      EXPECT_EQ(count[i], 1 + i % 5) << "an append must be stored wholly or not at all";
    }
  }
}

}  // namespace
}  // namespace bandsaw::coordinator
