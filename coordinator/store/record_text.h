#pragma once

// A journal record as text: a kind and named fields, as they are stored in the journal's table. The
// format is specified in this folder's README.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

struct RecordText {
  std::string kind;  ///< "job_added", …
  /// One line "name value" per field, in a fixed order; values escaped as in C.
  std::string fields;
  friend bool operator==(const RecordText&, const RecordText&) = default;
};

/// Returns the text of a record, which from_text() can parse.
RecordText to_text(const Record& record);

/// Parses a record. DATA_LOSS: the kind or a field is unknown, or a field is missing, malformed or
/// out of range. The message names the kind or the field.
absl::StatusOr<Record> from_text(const RecordText& text);

}  // namespace bandsaw::coordinator
