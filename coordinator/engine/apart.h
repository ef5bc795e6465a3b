#pragma once

#include "absl/status/status.h"

namespace bandsaw::coordinator {

/// The same status with nothing shared: for one that goes to another thread. Copies of a status
/// share their message by a count inside Debian's Abseil, which is not instrumented, so
/// ThreadSanitizer would report races that are none.
inline absl::Status apart(const absl::Status& status) {
  return absl::Status(status.code(), status.message());
}

}  // namespace bandsaw::coordinator
