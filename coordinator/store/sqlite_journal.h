#pragma once

// The journal in an SQLite file with a write-ahead log. Every append is one transaction, which is
// on disk when the call returns.

#include <cstdint>
#include <memory>
#include <string>

#include "absl/status/statusor.h"
#include "coordinator/store/journal.h"

struct sqlite3;
struct sqlite3_stmt;

namespace bandsaw::coordinator {

class SqliteJournal : public Journal {
 public:
  /// Makes the file if it does not exist. DATA_LOSS: it is damaged. FAILED_PRECONDITION: the schema
  /// is of a later version, or the file system cannot hold a write-ahead log.
  static absl::StatusOr<std::unique_ptr<SqliteJournal>> open(const std::string& path);
  ~SqliteJournal() override = default;

  absl::Status append(absl::Span<const Record> records) override;
  absl::Status replay(absl::FunctionRef<void(const Record&)> each) override;
  absl::Status rewrite(absl::Span<const Record> records) override;
  std::uint64_t size() const override { return last_; }

 private:
  struct CloseDatabase {
    void operator()(sqlite3* database) const;
  };
  struct CloseStatement {
    void operator()(sqlite3_stmt* statement) const;
  };
  using Statement = std::unique_ptr<sqlite3_stmt, CloseStatement>;

  SqliteJournal(sqlite3* database, std::string path)
      : database_(database), path_(std::move(path)) {}
  /// Sets SQLite's modes, checks the file's version and integrity, and reads the last sequence
  /// number.
  absl::Status prepare_file();
  absl::Status check_version();
  absl::Status execute(const char* sql);
  absl::StatusOr<Statement> prepare(const char* sql);
  /// Returns the first column of the first row, as text.
  absl::StatusOr<std::string> query(const char* sql);
  absl::Status insert(const Record& record, std::uint64_t sequence);
  /// Runs the statement `first` and then inserts the records with the sequence numbers that follow
  /// `after`, all in one transaction.
  absl::Status transact(const char* first, absl::Span<const Record> records, std::uint64_t after);
  /// Returns SQLite's present error as a status. `what`: what failed, such as "cannot read it".
  absl::Status error(const std::string& what) const;

  std::unique_ptr<sqlite3, CloseDatabase> database_;
  std::string path_;
  std::uint64_t last_ = 0;  ///< the highest sequence number in the file
  /// The file still has an earlier schema version, which the first transaction raises. open() does
  /// not raise the version, so that a journal can be read on a full disk.
  bool raise_version_ = false;
  Statement insert_;
};

}  // namespace bandsaw::coordinator
