#pragma once

// What must survive of the core: its records, in order. One of the four open doors.

#include "absl/functional/function_ref.h"
#include "absl/status/status.h"
#include "absl/types/span.h"
#include "coordinator/core/messages.h"

namespace bandsaw::coordinator {

/// Used by one thread at a time.
class Journal {
 public:
  virtual ~Journal() = default;
  /// All of the records or none. OK: they are on disk, after everything appended before.
  /// RESOURCE_EXHAUSTED, INTERNAL, …: none of them is there; the same append may be tried again.
  virtual absl::Status append(absl::Span<const Record> records) = 0;
  /// Every record, in the order written. DATA_LOSS naming the record that is damaged or not known.
  virtual absl::Status replay(absl::FunctionRef<void(const Record&)> each) = 0;
  /// These in the place of all that is there, or nothing changes. Errors as append.
  virtual absl::Status rewrite(absl::Span<const Record> records) = 0;
  /// Records that are there.
  virtual std::uint64_t size() const = 0;
};

}  // namespace bandsaw::coordinator
