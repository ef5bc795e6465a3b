#pragma once

// A few rows all over an image that come before the rest of it, which goes from the top: what they
// take tells what the others will, of which the first may be sky and the last a mesh. Only the time
// left is told by them. Bands are sized by those that are rendered in a row, each by the one
// before.

#include <cstdint>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Of images so high that the rest keeps its length.
inline constexpr std::uint32_t kProbes = 8;
inline std::uint32_t probes_of(std::uint32_t height) {
  return height >= kProbes * kProbes ? kProbes : 0;
}

/// number < probes_of(height). So few rows that it does not matter that bands are not sized by
/// them.
inline RowRange probe(std::uint32_t height, std::uint32_t number) {
  const std::uint32_t first = height * (2 * number + 1) / (2 * kProbes);
  return {first, first + 1 + height / 512};
}

/// What begins where a probe does is one: the rest is cut around them.
inline bool is_probe(std::uint32_t height, const Band& band) {
  const std::uint32_t number = band.rows.first * kProbes / height;  // the only one it can be
  return band.samples.first == 0 && number < probes_of(height) &&
         band.rows.first == probe(height, number).first;
}

}  // namespace bandsaw::coordinator
