#pragma once

// Time as the core sees it.

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Two readings of the time that comes with the inputs. Both never go back.
class CoreClock {
 public:
  /// `longest_step`: how much patience one input can use up, in seconds.
  explicit CoreClock(double longest_step) : longest_step_(longest_step) {}

  void advance(Time now) {
    const double passed = started_ && now > wall_ ? now - wall_ : 0;
    wall_ = started_ ? wall_ + passed : now;
    patience_ += passed < longest_step_ ? passed : longest_step_;
    started_ = true;
  }

  /// What people see: since when, how long, until when.
  Time wall() const { return wall_; }

  /// What silence is measured by. A coordinator that was stopped, or whose clock was set, finds
  /// hours gone between two inputs, and what the workers said meanwhile still unread: one input
  /// never uses up anybody's patience.
  Time patience() const { return patience_; }

 private:
  double longest_step_;
  bool started_ = false;
  Time wall_ = 0;
  Time patience_ = 0;
};

}  // namespace bandsaw::coordinator
