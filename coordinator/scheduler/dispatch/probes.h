#pragma once

// Probes: bands of a few rows, spread over the image, that are rendered before the rest, which is
// rendered from the top. Their render times predict the remaining time of the job. They do not
// change the cost map, which is learnt from the bands that are rendered in sequence.

#include <cstdint>

#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

inline constexpr std::uint32_t kProbes = 8;
/// Returns the number of probes of an image with this many rows; 0 for low images, which probes
/// would cut into too many small bands.
inline std::uint32_t probes_of(std::uint32_t height) {
  return height >= kProbes * kProbes ? kProbes : 0;
}

/// Returns the rows of a probe: one, and one more for each 512 rows of the image. These are so few
/// that the size need not depend on the worker's rate. number < probes_of(height).
inline RowRange probe(std::uint32_t height, std::uint32_t number) {
  const std::uint32_t first = height * (2 * number + 1) / (2 * kProbes);
  return {first, first + 1 + height / 512};
}

/// Returns true if the band is a probe: if it begins at the first row of one. Other bands cannot
/// begin there, because they are cut around probes.
inline bool is_probe(std::uint32_t height, const Band& band) {
  const std::uint32_t number = band.rows.first * kProbes / height;  // the only possible one
  return band.samples.first == 0 && number < probes_of(height) &&
         band.rows.first == probe(height, number).first;
}

}  // namespace bandsaw::coordinator
