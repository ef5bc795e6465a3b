#pragma once

// SplitMix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators",
// section 3; constants of Stafford's variant 13). The pixels of images and the contents of files
// depend on its values, so they MUST NOT change.

#include <cstdint>

namespace bandsaw {

/// Increment of the generator's state: 2^64 divided by the golden ratio.
inline constexpr std::uint64_t kSplitMixIncrement = 0x9e3779b97f4a7c15u;

/// Finaliser: a bijection in which each bit of the result depends on all bits of `x`.
constexpr std::uint64_t split_mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

}  // namespace bandsaw
