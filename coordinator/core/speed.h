#pragma once

// How fast something goes, from results that come in lumps.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Exponentially weighted mean of measured speeds, in samples a second. 0: nothing was measured.
class Speed {
 public:
  static constexpr double kNewest = 0.4;
  /// `newest`: the weight of this one.
  void measure(double samples_per_s, double newest = kNewest) {
    mean_ = mean_ > 0 ? (1 - newest) * mean_ + newest * samples_per_s : samples_per_s;
  }
  double mean() const { return mean_; }
  bool measured() const { return mean_ > 0; }

 private:
  double mean_ = 0;
};

/// Amount a second over the last ten seconds, or since the beginning if that is shorter.
class Throughput {
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
    Throughput copy = *this;
    copy.forget(now);
    double sum = 0;
    for (const double amount : copy.buckets_) {
      sum += amount;
    }
    return sum / std::clamp(now - since_, 1.0, static_cast<double>(kSeconds));
  }

  /// Counting begins here, not with the first amount.
  void start(Time now) {
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

  void forget(Time now) {
    const double second = std::floor(now);
    for (double gone = std::max(newest_ + 1, second - kSeconds + 1); gone <= second; ++gone) {
      buckets_[index(gone)] = 0;
    }
    newest_ = std::max(newest_, second);
  }

  std::array<double, kSeconds> buckets_{};
  bool started_ = false;
  Time since_ = 0;
  double newest_ = 0;
};

}  // namespace bandsaw::coordinator
