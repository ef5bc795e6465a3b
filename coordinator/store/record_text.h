#pragma once

// A record of the journal as text: a kind and named fields. The form is written down in this
// folder's README.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/core/messages.h"

namespace bandsaw::coordinator {

struct RecordText {
  std::string kind;    ///< "job_added", …
  std::string fields;  ///< a line "name value" each, in a fixed order; values escaped as in C
  friend bool operator==(const RecordText&, const RecordText&) = default;
};

RecordText to_text(const Record& record);

/// DATA_LOSS naming the field: unknown kind or field, a field missing, a value out of range.
absl::StatusOr<Record> from_text(const RecordText& text);

}  // namespace bandsaw::coordinator
