#pragma once

// Answer: a callback that is called exactly once. If nobody has called the callback, the destructor
// of Answer calls it with UNAVAILABLE, so that no caller waits for a coordinator that has stopped.

#include <functional>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Returns a copy that shares nothing with `status`, for a status that goes to another thread.
/// Copies of a status share their message by a reference count, which the compiled code of Abseil
/// changes. Debian's build of Abseil is not instrumented for ThreadSanitizer. So ThreadSanitizer
/// would report false races.
inline absl::Status unshared_status(const absl::Status& status) {
  return absl::Status(status.code(), status.message());
}

template <class T>
class Answer {
 public:
  Answer() = default;
  explicit Answer(std::function<void(absl::StatusOr<T>)> done) : done_(std::move(done)) {}
  Answer(Answer&& other) noexcept : done_(std::exchange(other.done_, nullptr)) {}
  Answer& operator=(Answer&& other) noexcept {
    std::swap(done_, other.done_);
    return *this;
  }
  ~Answer() { (*this)(absl::UnavailableError("the coordinator is stopping; try again")); }

  void operator()(absl::StatusOr<T> value) {
    if (const auto done = std::exchange(done_, nullptr)) {
      if (value.ok()) {
        done(std::move(value));
      } else {
        done(unshared_status(value.status()));
      }
    }
  }

 private:
  std::function<void(absl::StatusOr<T>)> done_;
};

}  // namespace bandsaw::coordinator
