#pragma once

// Virtual time and random numbers of a simulated farm. The same seed gives the same run.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

#include "renderlib/base/split_mix.h"

namespace bandsaw::coordinator::sim {

/// Random numbers of SplitMix64 (renderlib/base/split_mix.h).
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed * kSplitMixIncrement + 1) {}
  std::uint64_t bits() { return split_mix(state_ += kSplitMixIncrement); }
  /// Returns a number in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Returns a number in [low, high) that is uniform in the logarithm; low > 0.
  double between_log(double low, double high) {
    return low * std::exp(uniform() * std::log(high / low));
  }
  /// Returns an integer in [low, high].
  std::uint64_t pick(std::uint64_t low, std::uint64_t high) {
    return low + bits() % (high - low + 1);
  }
  bool happens(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
};

/// The events of a simulation. They run in the order of their times. Events of the same time run in
/// the order in which they were added.
class Agenda {
 public:
  double now() const { return now_; }
  /// Adds an event at this time, in seconds; a time in the past means now.
  void at(double time, std::function<void()> what) {
    items_.emplace(std::pair(std::max(time, now_), order_++), std::move(what));
  }
  void in(double seconds, std::function<void()> what) { at(now_ + seconds, std::move(what)); }
  /// Sets the time to the time of the next event, and runs the event. Returns false if no event is
  /// left.
  bool run_next() {
    if (items_.empty()) {
      return false;
    }
    auto item = items_.extract(items_.begin());
    now_ = item.key().first;
    item.mapped()();
    return true;
  }

 private:
  double now_ = 0;
  std::uint64_t order_ = 0;
  std::map<std::pair<double, std::uint64_t>, std::function<void()>> items_;
};

}  // namespace bandsaw::coordinator::sim
