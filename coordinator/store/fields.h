#pragma once

// Named values as lines of text: "name value\n", values escaped as in C. Written and read in one
// fixed order.

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
  /// The shortest digits that read back as the same double.
  void real(absl::string_view name, double value);
  std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// Reads what FieldWriter wrote, in the same order. The first thing that is wrong stays in
/// `status()`; after it all values are empty or zero.
class FieldReader {
 public:
  explicit FieldReader(absl::string_view fields) : rest_(fields) {}
  std::string text(absl::string_view name);
  std::uint64_t number(absl::string_view name, std::uint64_t most = UINT64_MAX);
  double real(absl::string_view name);
  /// Whether the next field bears this name; of fields that older writers did not know.
  bool next_is(absl::string_view name) const;
  /// DATA_LOSS: a field was missing, malformed, out of range, or left over at the end.
  absl::Status finish();
  /// Marks the record as wrong for a reason of the caller's.
  void refuse(std::string reason);

 private:
  absl::string_view value_of(absl::string_view name);
  absl::string_view rest_;
  absl::Status status_;
};

}  // namespace bandsaw::coordinator
