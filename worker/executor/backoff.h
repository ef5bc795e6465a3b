#pragma once

#include <algorithm>
#include <chrono>
#include <random>

namespace bandsaw::worker {

/// Waiting times between attempts to reach the coordinator: exponential backoff from 200 ms to 5 s
/// with jitter. Each wait is shortened by a random amount of up to one half, so that the workers do
/// not all reconnect at the same moment after a restart of the coordinator.
class Backoff {
 public:
  explicit Backoff(std::uint64_t seed) : random_(seed) {}

  /// Returns the time to wait before the next attempt.
  std::chrono::milliseconds next() {
    const auto wait = next_;
    next_ = std::min(next_ * 2, kMax);
    return std::chrono::milliseconds(
        std::uniform_int_distribution<std::int64_t>(wait.count() / 2, wait.count())(random_));
  }
  /// To be called after a success: the next wait is short again.
  void reset() { next_ = kMin; }

 private:
  static constexpr std::chrono::milliseconds kMin{200};
  static constexpr std::chrono::milliseconds kMax{5000};
  std::chrono::milliseconds next_ = kMin;
  std::mt19937_64 random_;
};

}  // namespace bandsaw::worker
