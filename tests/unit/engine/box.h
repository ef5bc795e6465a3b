#pragma once

// Passes values from a callback, which runs on another thread, to the test that waits for them. A
// wait of more than a minute aborts the test.

#include <chrono>
#include <functional>
#include <optional>
#include <utility>

#include "renderlib/base/check.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Holds the newest value that was put. Thread-safe.
template <class T>
class Box {
 public:
  void put(T value) EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    value_ = std::move(value);
    changed_.notify_all();
  }
  /// Waits until the newest value satisfies `fits`, and returns a copy of this value.
  T wait(const std::function<bool(const T&)>& fits = [](const T&) { return true; })
      EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    wait_until(fits);
    return *value_;
  }
  /// Waits for a value, removes it and returns it, so that the value belongs to the caller alone. A
  /// status that is shared with another thread would give false reports of races by ThreadSanitizer
  /// (coordinator/engine/answer.h).
  T take() EXCLUDES(mutex_) {
    MutexLock lock(mutex_);
    wait_until([](const T&) { return true; });
    T value = *std::move(value_);
    value_.reset();
    return value;
  }

 private:
  void wait_until(const std::function<bool(const T&)>& fits) REQUIRES(mutex_) {
    const auto until = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (!value_ || !fits(*value_)) {
      BANDSAW_CHECK(std::chrono::steady_clock::now() < until, "the callback comes");
      changed_.wait_for(mutex_, std::chrono::milliseconds(100));
    }
  }

  Mutex mutex_;
  CondVar changed_;
  std::optional<T> value_ GUARDED_BY(mutex_);
};

}  // namespace bandsaw::coordinator
