#pragma once

// Counts the seconds for which a job or a sequence has been worked on.

#include <algorithm>
#include <optional>

#include "coordinator/scheduler/api/ids.h"

namespace bandsaw::coordinator {

/// A clock that can be stopped. It stands still at 0 at first.
class WorkClock {
 public:
  bool runs() const { return since_.has_value(); }
  /// Returns the seconds that it has counted up to `now`.
  double elapsed(Time now) const { return before_ + (since_ ? std::max(0.0, now - *since_) : 0.0); }
  /// Counts from `now` on. No effect if it runs already.
  void start(Time now) { since_ = since_.value_or(now); }
  void stop(Time now) { set(elapsed(now)); }
  /// Stops it at this number of seconds.
  void set(double seconds) {
    before_ = seconds;
    since_.reset();
  }

 private:
  double before_ = 0;          ///< counted up to since_
  std::optional<Time> since_;  ///< nullopt: it stands still
};

}  // namespace bandsaw::coordinator
