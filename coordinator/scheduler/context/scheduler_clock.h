#pragma once

#include "coordinator/scheduler/api/ids.h"

namespace bandsaw::coordinator {

/// The time of the scheduler. Each input of the scheduler comes with a time, and from these times
/// two clocks are made, one for display and rates, one for timeouts. Neither clock ever goes back.
class SchedulerClock {
 public:
  /// `max_timeout_step`: maximum advance of the timeout clock by one input, in seconds.
  explicit SchedulerClock(double max_timeout_step) : max_timeout_step_(max_timeout_step) {}

  /// `now`: the time of an input. The first input sets wall() to `now`. A later input whose `now`
  /// is after wall() sets wall() to `now`, and advances the timeout clock by the same difference,
  /// but by at most max_timeout_step. Any other input changes nothing.
  void advance(Time now) {
    const double passed = started_ && now > wall_ ? now - wall_ : 0;
    wall_ = started_ ? wall_ + passed : now;
    timeout_clock_ += passed < max_timeout_step_ ? passed : max_timeout_step_;
    started_ = true;
  }

  /// Returns the time as users see it, for durations and rates.
  Time wall() const { return wall_; }

  /// Returns the time for timeouts. After the coordinator was stopped, or its clock was set, hours
  /// can lie between two inputs while messages of the workers are still unread. So one input
  /// advances this clock by at most max_timeout_step.
  Time timeout_clock() const { return timeout_clock_; }

 private:
  double max_timeout_step_;
  bool started_ = false;
  Time wall_ = 0;
  Time timeout_clock_ = 0;
};

}  // namespace bandsaw::coordinator
