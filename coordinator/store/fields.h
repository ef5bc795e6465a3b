#pragma once

// Writes and reads named values as text, for journal records and small files. Each value is a line
// "name value", and the lines have a fixed order. Text values are escaped as in C.

#include <charconv>
#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/string_view.h"

namespace bandsaw::coordinator {

class FieldWriter {
 public:
  void text(absl::string_view name, absl::string_view value);
  void number(absl::string_view name, std::uint64_t value);
  /// Writes the shortest decimal that reads back as the same double.
  void real(absl::string_view name, double value);
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Reads the output of FieldWriter in the same order. The first error is kept in the status; after
/// it all values are empty or zero.
class FieldReader {
 public:
  explicit FieldReader(absl::string_view fields) : rest_(fields) {}
  std::string text(absl::string_view name);
  /// A number above `most` is an error.
  std::uint64_t number(absl::string_view name, std::uint64_t most = UINT64_MAX);
  double real(absl::string_view name);
  /// Returns true if the next field has this name. Needed for fields that older versions did not
  /// write.
  bool next_is(absl::string_view name) const;
  /// Returns the status. DATA_LOSS: a field is missing, malformed, out of range, or left over at
  /// the end.
  absl::Status finish();
  /// Sets the status to DATA_LOSS with this reason, unless it is an error already. For errors that
  /// only the caller can find.
  void refuse(std::string reason);

 private:
  /// Takes the next line and returns the value in it. If the line has another name, sets the error
  /// and returns an empty text.
  absl::string_view value_of(absl::string_view name);
  absl::string_view rest_;
  absl::Status status_;
};

}  // namespace bandsaw::coordinator
