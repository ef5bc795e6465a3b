#pragma once

// Schedule of the samples that a plan (adaptive_plan.h) gives to half tiles (tile_samples.h). The
// coordinator makes one for each adaptive job. A pass is a range of samples that is rendered of the
// whole image.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/render/adaptive_plan.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// Decides which samples half tiles take in each pass after the pilot.
///
/// A half tile always has the first samples of its own sequence: 4, 5, 6 or 7 quarters of 2^k. If
/// some samples were left out, the others would not form nets of Sobol' points. Complete nets
/// matter, because in smooth regions the error falls with each of them. A half tile takes its next
/// quarter when the plan gives it that many samples. Half tiles of equal share take it in different
/// passes, spread evenly over the image, so that on average they have what the plan gives. If all
/// levels of a half of the image are 6 (uniform), it takes the samples of each pass.
class TileSchedule {
 public:
  /// `plan.levels` has one digit 0 to f for each half tile.
  TileSchedule(const TileGrid& grid, const TilePlan& plan);

  /// Returns the samples for `pass`, which MUST follow the previous one; the first pass follows the
  /// pilot.
  TileSamples next(const SampleRange& pass);

 private:
  /// Returns the samples of half tile i in the pass: the next node after the samples that it has,
  /// or none if too few are due.
  SampleRange node_of(std::size_t i, const SampleRange& pass) const;

  TileGrid grid_;
  TilePlan plan_;
  /// For each half of the image: true if all its levels are 6.
  std::array<bool, 2> even_{true, true};
  std::vector<std::uint64_t> taken_;  ///< samples taken so far by each half tile
};

}  // namespace bandsaw
