#pragma once

// Estimates of rates (amount per second) from results that arrive at irregular times.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "coordinator/scheduler/api/ids.h"

namespace bandsaw::coordinator {

/// Exponentially weighted mean of measured rates. 0: nothing has been measured.
class MeanRate {
 public:
  /// With this weight, the last four measurements have 87 % of the total weight.
  static constexpr double kDefaultWeight = 0.4;
  /// `weight`: the weight of this measurement, (0, 1].
  void measure(double per_second, double weight = kDefaultWeight) {
    mean_ = mean_ > 0 ? (1 - weight) * mean_ + weight * per_second : per_second;
  }
  double mean() const { return mean_; }
  bool measured() const { return mean_ > 0; }

 private:
  double mean_ = 0;
};

/// Amount per second over the last ten seconds, or since the start if that is shorter.
class RecentRate {
 public:
  void add(Time now, double amount) {
    forget(now);
    if (!started_) {
      started_ = true;
      since_ = now;
    }
    buckets_[index(now)] += amount;
  }

  double per_second(Time now) const {
    RecentRate copy = *this;
    copy.forget(now);
    double sum = 0;
    for (const double amount : copy.buckets_) {
      sum += amount;
    }
    return sum / std::clamp(now - since_, 1.0, static_cast<double>(kSeconds));
  }

  /// Forgets all amounts. The time over which the rate is taken begins at `now`, not at the first
  /// amount that is added later.
  void start(Time now) {
    *this = {};
    started_ = true;
    since_ = now;
    newest_ = std::floor(now);
  }

 private:
  static constexpr std::size_t kSeconds = 10;

  static std::size_t index(Time now) {
    const double second = std::floor(now);
    return static_cast<std::size_t>(second - std::floor(second / kSeconds) * kSeconds);
  }

  /// Clears the buckets of the seconds after newest_ up to `now`. These buckets may hold amounts of
  /// seconds that are at least kSeconds ago.
  void forget(Time now) {
    const double second = std::floor(now);
    for (double gone = std::max(newest_ + 1, second - kSeconds + 1); gone <= second; ++gone) {
      buckets_[index(gone)] = 0;
    }
    newest_ = std::max(newest_, second);
  }

  /// The amounts of each of the last kSeconds seconds. Second s has the index s modulo kSeconds.
  std::array<double, kSeconds> buckets_{};
  bool started_ = false;
  Time since_ = 0;
  double newest_ = 0;  ///< the last second, a whole number, for which the buckets are valid
};

}  // namespace bandsaw::coordinator
