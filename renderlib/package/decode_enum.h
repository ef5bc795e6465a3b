#pragma once

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {

/// Converts an enum of proto/package.proto to the enum `Ours`, whose values count from 0 in the
/// same order. `first` and `last` are the first and last valid value of the protocol; `first` is 1
/// if the protocol's 0 means "unspecified". Returns INVALID_ARGUMENT, which names `field`, for
/// other values.
template <class Ours>
absl::StatusOr<Ours> decode_enum(int value, int first, int last, const std::string& field) {
  if (value < first || value > last) {
    return manifest_error(field, absl::StrCat("must lie in [", first, ", ", last, "], is ", value));
  }
  return static_cast<Ours>(value - first);
}

/// Returns decode_enum(value, 1, last, field), for an enum whose 0 means "unspecified".
template <class Ours>
absl::StatusOr<Ours> decode_enum(int value, int last, const std::string& field) {
  return decode_enum<Ours>(value, 1, last, field);
}

}  // namespace bandsaw
