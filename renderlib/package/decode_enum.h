#pragma once

#include <string>

#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "renderlib/package/manifest.h"

namespace bandsaw {

/// Ours count from 0 in the same order; `first` is where the protocol begins: 1 where its 0 means
/// "not said".
template <class Ours>
absl::StatusOr<Ours> decode_enum(int value, int first, int last, const std::string& field) {
  if (value < first || value > last) {
    return manifest_error(field, absl::StrCat("must lie in [", first, ", ", last, "], is ", value));
  }
  return static_cast<Ours>(value - first);
}

/// The same from 1.
template <class Ours>
absl::StatusOr<Ours> decode_enum(int value, int last, const std::string& field) {
  return decode_enum<Ours>(value, 1, last, field);
}

}  // namespace bandsaw
