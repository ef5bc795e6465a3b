#pragma once

#include <cstdint>

namespace bandsaw {

/// Returns the seed of a frame of a sequence (an animation), modulo 2^64. Each frame has a
/// different seed, so that the noise changes from frame to frame. `seed` is the seed of frame
/// 0. `frame` may be negative.
constexpr std::uint64_t seed_of_frame(std::uint64_t seed, std::int64_t frame) {
  return seed + static_cast<std::uint64_t>(frame);
}

}  // namespace bandsaw
