#pragma once

// The engine's clock, an interface that tests replace.

#include <chrono>

#include "coordinator/scheduler/api/ids.h"

namespace bandsaw::coordinator {

/// Returns the seconds since an arbitrary start. The value never decreases.
inline Time steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Thread-safe.
class Clock {
 public:
  virtual ~Clock() = default;
  /// Returns the seconds since an arbitrary start. The value never decreases.
  virtual Time now() const = 0;
};

class SteadyClock : public Clock {
 public:
  Time now() const override { return steady_seconds(); }
};

}  // namespace bandsaw::coordinator
