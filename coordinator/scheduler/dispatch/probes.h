#pragma once

// Probes: bands of a few rows, spread over the image, that are rendered first. The other rows are
// rendered after them, from the top. The render times of the probes predict the remaining time of
// the job. Probes do not change the cost map (the relative costs of rows), which is learnt from the
// other bands.

#include <cstdint>

#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

inline constexpr std::uint32_t kProbes = 8;
/// Returns the number of probes of an image with this many rows; 0 for low images, which probes
/// would cut into too many small bands.
inline std::uint32_t probes_of(std::uint32_t height) {
  return height >= kProbes * kProbes ? kProbes : 0;
}

/// Returns the rows of a probe. `number`: index of the probe, < probes_of(height). A probe has one
/// row, and one more for each 512 rows of the image. It is so small that its size need not depend
/// on the worker's rate.
inline RowRange probe(std::uint32_t height, std::uint32_t number) {
  const std::uint32_t first = height * (2 * number + 1) / (2 * kProbes);
  return {first, first + 1 + height / 512};
}

/// Returns true if the band is a probe, that is, if it begins at the first sample and at the first
/// row of a probe. No other band begins so, because the other bands are cut around probes.
inline bool is_probe(std::uint32_t height, const Band& band) {
  // The number of the only probe that can begin at this row.
  const std::uint32_t number = band.rows.first * kProbes / height;
  return band.samples.first == 0 && number < probes_of(height) &&
         band.rows.first == probe(height, number).first;
}

}  // namespace bandsaw::coordinator
