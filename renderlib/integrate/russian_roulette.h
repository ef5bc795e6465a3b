#pragma once

// Russian roulette: ends paths of low throughput at random and scales up the others, so that the
// expected value stays the same (README.md, "Russian roulette").

#include <algorithm>
#include <cstdint>

#include "renderlib/integrate/path_state.h"

namespace bandsaw {

/// Number of the first scattering after which Russian roulette may end a path, counted from 1.
inline constexpr std::uint32_t kRouletteDepth = 3;

/// A path always survives if its throughput, divided by PathState::compression, is at least this.
/// The compression is the factor by which refraction and guiding scaled the throughput.
inline constexpr double kRouletteThroughput = 0.25;

/// Applies Russian roulette after scattering `depth` (counted from 0), with the random number
/// `number` in [0, 1). Returns false if the path ends. The survival probability is at least 1/20,
/// so that no throughput grows more than 20 times.
inline bool survives_roulette(const PathContext& context, std::uint32_t depth, double number,
                              PathState& path) {
  if (context.options.russian_roulette && depth + 1 >= kRouletteDepth) {
    const double survival = std::clamp(
        max_component(path.throughput) / (path.compression * kRouletteThroughput), 0.05, 1.0);
    if (number >= survival) {
      return false;
    }
    path.throughput = path.throughput * static_cast<float>(1 / survival);
  }
  return !is_black(path.throughput);
}

}  // namespace bandsaw
