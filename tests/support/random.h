#pragma once

// Random numbers for tests, equal for all libraries and compilers (unlike the distributions of the
// standard library).

#include <cstdint>

#include "renderlib/base/split_mix.h"

namespace bandsaw::test {

class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}

  /// Returns 64 random bits, by SplitMix64.
  std::uint64_t bits() {
    state_ += kSplitMixIncrement;
    return split_mix(state_);
  }
  /// Uniform in [0, 1).
  double uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }
  /// Uniform in [0, n).
  std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>((bits() >> 32) * n >> 32);
  }

 private:
  std::uint64_t state_;
};

}  // namespace bandsaw::test
