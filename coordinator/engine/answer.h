#pragma once

// A callback that is called exactly once, come what may: one that is dropped says UNAVAILABLE, so
// that nobody waits for a coordinator that has stopped.

#include <functional>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "coordinator/engine/apart.h"

namespace bandsaw::coordinator {

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
        done(apart(value.status()));
      }
    }
  }

 private:
  std::function<void(absl::StatusOr<T>)> done_;
};

}  // namespace bandsaw::coordinator
