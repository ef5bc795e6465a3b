#pragma once

// Virtual time and random numbers of a simulated farm. The same seed gives the same run.

#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>

namespace bandsaw::coordinator::sim {

/// SplitMix64 (Steele, Lea, Flood 2014, "Fast splittable pseudorandom number generators").
class Chance {
 public:
  explicit Chance(std::uint64_t seed) : state_(seed * 0x9E3779B97F4A7C15ull + 1) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
  }
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  /// Uniform in the logarithm.
  double between_log(double low, double high) {
    return low * std::exp(uniform() * std::log(high / low));
  }
  /// [low, high]
  std::uint64_t pick(std::uint64_t low, std::uint64_t high) {
    return low + bits() % (high - low + 1);
  }
  bool happens(double probability) { return uniform() < probability; }

 private:
  std::uint64_t state_;
};

class Agenda {
 public:
  double now() const { return now_; }
  void at(double time, std::function<void()> what) {
    items_.emplace(std::pair(std::max(time, now_), order_++), std::move(what));
  }
  void in(double seconds, std::function<void()> what) { at(now_ + seconds, std::move(what)); }
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
