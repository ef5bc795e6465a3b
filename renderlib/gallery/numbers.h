#pragma once

#include <cstdint>

#include "renderlib/base/split_mix.h"
#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// A fixed sequence of numbers by which the shapes of a generated scene are placed.
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}

  /// Returns a number in [0, 1).
  double next() {
    state_ += kSplitMixIncrement;
    return static_cast<double>(split_mix(state_) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * next(); }
  /// Returns a vector whose coordinates lie between the two numbers.
  Vec3 vec(double low, double high) {
    const double x = between(low, high);
    const double y = between(low, high);
    return {x, y, between(low, high)};
  }

 private:
  std::uint64_t state_;
};

}  // namespace bandsaw::gallery
