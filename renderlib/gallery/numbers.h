#pragma once

#include <cstdint>

#include "renderlib/math/vec.h"

namespace bandsaw::gallery {

/// A fixed sequence of numbers, for where things lie in a made scene: Steele, Lea and Flood 2014,
/// "Fast Splittable Pseudorandom Number Generators" (SplitMix64).
class Numbers {
 public:
  explicit Numbers(std::uint64_t seed) : state_(seed) {}

  /// In [0, 1).
  double next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9;
    z = (z ^ (z >> 27)) * 0x94d049bb133111eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }
  double between(double low, double high) { return low + (high - low) * next(); }
  /// Each coordinate between the two.
  Vec3 vec(double low, double high) {
    const double x = between(low, high);
    const double y = between(low, high);
    return {x, y, between(low, high)};
  }

 private:
  std::uint64_t state_;
};

}  // namespace bandsaw::gallery
