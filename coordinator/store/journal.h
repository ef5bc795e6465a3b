#pragma once

// Interface of the journal: the scheduler's records (scheduler/api/records.h) on disk, in order.
// After a restart the scheduler's state is rebuilt from them.

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/types/span.h"
#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Not thread-safe.
class Journal {
 public:
  virtual ~Journal() = default;
  /// Appends all of the records or none. OK: they are on disk, and they follow the records of all
  /// earlier appends. Any other status, such as RESOURCE_EXHAUSTED: none of them is in the journal,
  /// and the same append may be retried.
  virtual absl::Status append(absl::Span<const Record> records) = 0;
  /// Calls `each` with every record in the order written. DATA_LOSS names a record that is damaged
  /// or of an unknown kind.
  virtual absl::Status replay(absl::FunctionRef<void(const Record&)> each) = 0;
  /// Atomically replaces all records of the journal by `records`. Errors as append.
  virtual absl::Status rewrite(absl::Span<const Record> records) = 0;
  /// Returns the number of records in the journal.
  virtual std::uint64_t size() const = 0;
};

}  // namespace bandsaw::coordinator
