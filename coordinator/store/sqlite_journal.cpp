// One table with a row for each record: its number, kind, fields and a checksum. Every append is
// one transaction, synced by SQLite before it returns.

#include "coordinator/store/sqlite_journal.h"

#include <sqlite3.h>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "coordinator/store/record_text.h"
#include "proto/wire/digest.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

constexpr int kSchema = 13;  // earlier versions can be read (README.md)
constexpr char kTables[] =
    "CREATE TABLE IF NOT EXISTS record (sequence INTEGER PRIMARY KEY, kind TEXT NOT NULL,"
    " fields TEXT NOT NULL, seal TEXT NOT NULL) STRICT;";

/// Returns the SQL statement that sets the file's schema version to kSchema.
std::string version_statement() { return absl::StrCat("PRAGMA user_version = ", kSchema, ";"); }

/// Returns a checksum of a record. SQLite itself does not detect a changed byte in a value, but the
/// checksum does.
std::string seal(std::uint64_t sequence, const RecordText& text) {
  return wire::sha256(absl::StrCat(sequence, "\n", text.kind, "\n", text.fields))
      .hex()
      .substr(0, 16);
}

/// Returns a column of a row as text; empty if the value is NULL.
std::string column(sqlite3_stmt* row, int index) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, index));
  return text == nullptr
             ? std::string()
             : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, index)));
}

/// Returns the status code for a result code of SQLite.
absl::StatusCode code_of(int result) {
  switch (result) {
    case SQLITE_FULL:
    case SQLITE_IOERR:  // also the error of a full disk if the write-ahead log does not fit
    case SQLITE_NOMEM:
      return absl::StatusCode::kResourceExhausted;
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      return absl::StatusCode::kDataLoss;
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      return absl::StatusCode::kFailedPrecondition;
    case SQLITE_CANTOPEN:
    case SQLITE_READONLY:
    case SQLITE_PERM:
      return absl::StatusCode::kPermissionDenied;
    default:
      return absl::StatusCode::kInternal;
  }
}

absl::Status bind_text(sqlite3_stmt* statement, int index, const std::string& text) {
  if (sqlite3_bind_text64(statement, index, text.data(), text.size(), SQLITE_TRANSIENT,
                          SQLITE_UTF8) != SQLITE_OK) {
    return absl::ResourceExhaustedError("no memory for a record of the journal");
  }
  return absl::OkStatus();
}

}  // namespace

void SqliteJournal::CloseDatabase::operator()(sqlite3* database) const {
  sqlite3_close_v2(database);
}
void SqliteJournal::CloseStatement::operator()(sqlite3_stmt* statement) const {
  sqlite3_finalize(statement);
}

absl::StatusOr<std::unique_ptr<SqliteJournal>> SqliteJournal::open(const std::string& path) {
  sqlite3* database = nullptr;
  const int result =
      sqlite3_open_v2(path.c_str(), &database,
                      SQLITE_OPEN_READWRITE | SQLITE_OPEN_CREATE | SQLITE_OPEN_NOMUTEX, nullptr);
  std::unique_ptr<SqliteJournal> journal(new SqliteJournal(database, path));
  if (result != SQLITE_OK) {
    return journal->error("cannot open it");
  }
  RETURN_IF_ERROR(journal->prepare_file());
  return journal;
}

absl::Status SqliteJournal::prepare_file() {
  RETURN_IF_ERROR(execute("PRAGMA locking_mode = EXCLUSIVE;"));
  ASSIGN_OR_RETURN(const std::string mode, query("PRAGMA journal_mode = WAL;"));
  if (mode != "wal") {
    return absl::FailedPreconditionError(
        absl::StrCat("the journal ", path_, " cannot keep a write-ahead log there (SQLite says '",
                     mode, "'); choose a local disk with --data"));
  }
  RETURN_IF_ERROR(execute("PRAGMA synchronous = FULL;"));
  RETURN_IF_ERROR(check_version());
  ASSIGN_OR_RETURN(const std::string sound, query("PRAGMA quick_check(1);"));
  if (sound != "ok") {
    return absl::DataLossError(
        absl::StrCat("the journal ", path_, " is damaged: ", sound, "; restore it from a backup"));
  }
  ASSIGN_OR_RETURN(const std::string last, query("SELECT coalesce(max(sequence), 0) FROM record;"));
  if (!absl::SimpleAtoi(last, &last_)) {
    return absl::DataLossError(
        absl::StrCat("the journal ", path_, " has a record with the sequence number ", last));
  }
  ASSIGN_OR_RETURN(
      insert_, prepare("INSERT INTO record (sequence, kind, fields, seal) VALUES (?, ?, ?, ?);"));
  return absl::OkStatus();
}

/// Makes the table in a new file. If the schema version is earlier than kSchema, notes that it must
/// be raised; if it is later, returns an error.
absl::Status SqliteJournal::check_version() {
  ASSIGN_OR_RETURN(const std::string version, query("PRAGMA user_version;"));
  int found = 0;
  if (absl::SimpleAtoi(version, &found) && found > 0 && found < kSchema) {
    raise_version_ = true;
    return absl::OkStatus();
  }
  if (version == "0") {
    RETURN_IF_ERROR(execute(kTables));
    return execute(version_statement().c_str());
  }
  if (version != absl::StrCat(kSchema)) {
    return absl::FailedPreconditionError(absl::StrCat("the journal ", path_, " has schema ",
                                                      version, ", this program knows ", kSchema,
                                                      "; use the version that wrote it"));
  }
  return absl::OkStatus();
}

absl::Status SqliteJournal::append(absl::Span<const Record> records) {
  return records.empty() ? absl::OkStatus() : transact("", records, last_);
}

absl::Status SqliteJournal::rewrite(absl::Span<const Record> records) {
  RETURN_IF_ERROR(transact("DELETE FROM record;", records, 0));
  // Frees the space of the deleted records. If this fails, later records reuse the space.
  execute("PRAGMA wal_checkpoint(TRUNCATE);").IgnoreError();
  execute("VACUUM;").IgnoreError();
  return absl::OkStatus();
}

absl::Status SqliteJournal::transact(const char* first, absl::Span<const Record> records,
                                     std::uint64_t after) {
  RETURN_IF_ERROR(execute("BEGIN IMMEDIATE;"));
  std::uint64_t sequence = after;
  absl::Status status = execute(first);
  if (status.ok() && raise_version_) {
    status = execute(version_statement().c_str());
  }
  for (std::size_t i = 0; i < records.size() && status.ok(); ++i) {
    status = insert(records[i], ++sequence);
  }
  if (status.ok()) {
    status = execute("COMMIT;");
  }
  if (!status.ok()) {
    if (sqlite3_get_autocommit(database_.get()) == 0) {
      execute("ROLLBACK;").IgnoreError();
    }
    return status;
  }
  last_ = sequence;
  raise_version_ = false;
  return absl::OkStatus();
}

absl::Status SqliteJournal::insert(const Record& record, std::uint64_t sequence) {
  const RecordText text = to_text(record);
  sqlite3_stmt* statement = insert_.get();
  sqlite3_bind_int64(statement, 1, static_cast<sqlite3_int64>(sequence));
  RETURN_IF_ERROR(bind_text(statement, 2, text.kind));
  RETURN_IF_ERROR(bind_text(statement, 3, text.fields));
  RETURN_IF_ERROR(bind_text(statement, 4, seal(sequence, text)));
  const int result = sqlite3_step(statement);
  const absl::Status status =
      result == SQLITE_DONE ? absl::OkStatus() : error("cannot add a record");
  sqlite3_reset(statement);
  return status;
}

absl::Status SqliteJournal::replay(absl::FunctionRef<void(const Record&)> each) {
  ASSIGN_OR_RETURN(const Statement rows,
                   prepare("SELECT sequence, kind, fields, seal FROM record ORDER BY sequence;"));
  std::uint64_t expected = 1;
  int result = SQLITE_ROW;
  while ((result = sqlite3_step(rows.get())) == SQLITE_ROW) {
    const auto sequence = static_cast<std::uint64_t>(sqlite3_column_int64(rows.get(), 0));
    const RecordText text{.kind = column(rows.get(), 1), .fields = column(rows.get(), 2)};
    const std::string where = absl::StrCat("record ", expected, " of the journal ", path_);
    if (sequence != expected || column(rows.get(), 3) != seal(sequence, text)) {
      return absl::DataLossError(absl::StrCat(
          where, sequence != expected ? " is missing" : " is damaged",
          "; restore the data folder from a backup, or choose another folder with --data"));
    }
    const absl::StatusOr<Record> record = from_text(text);
    if (!record.ok()) {
      return absl::DataLossError(
          absl::StrCat(where, " cannot be read: ", record.status().message()));
    }
    each(*record);
    ++expected;
  }
  return result == SQLITE_DONE ? absl::OkStatus() : error("cannot read it");
}

absl::Status SqliteJournal::execute(const char* sql) {
  if (sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr) != SQLITE_OK) {
    return error("cannot write it");
  }
  return absl::OkStatus();
}

absl::StatusOr<SqliteJournal::Statement> SqliteJournal::prepare(const char* sql) {
  sqlite3_stmt* statement = nullptr;
  if (sqlite3_prepare_v2(database_.get(), sql, -1, &statement, nullptr) != SQLITE_OK) {
    return error("cannot read it");
  }
  return Statement(statement);
}

absl::StatusOr<std::string> SqliteJournal::query(const char* sql) {
  ASSIGN_OR_RETURN(const Statement statement, prepare(sql));
  if (sqlite3_step(statement.get()) != SQLITE_ROW) {
    return error("cannot read it");
  }
  return column(statement.get(), 0);
}

absl::Status SqliteJournal::error(const std::string& what) const {
  const int result = sqlite3_errcode(database_.get()) & 0xff;
  return absl::Status(code_of(result), absl::StrCat("journal ", path_, ": ", what, ": ",
                                                    sqlite3_errmsg(database_.get())));
}

}  // namespace bandsaw::coordinator
