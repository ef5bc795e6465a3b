#pragma once

// Schedule of the samples that a plan (adaptive_plan.h) gives to half tiles (tile_samples.h). The
// coordinator makes one schedule for each adaptive job. A pass is one range of samples, rendered
// for the whole image.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/render/adaptive_plan.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// Decides which samples half tiles take in each pass after the pilot.
///
/// A half tile always has the first samples of its own sequence, and their number is 4, 5, 6 or 7
/// quarters of 2^k. If some samples were left out, the others would not form nets of Sobol' points.
/// Complete nets matter, because in smooth regions the error falls with each complete net.
///
/// A half tile takes its next node when it is far enough behind the plan. Half tiles of equal share
/// take their nodes in different passes, spread evenly over the image. So on average the half tiles
/// have as many samples as the plan gives. The plan has a level for each half tile; level 6 stands
/// for as many samples as uniform sampling takes. If all levels of one half of the image (even or
/// odd) are 6, all half tiles of this half take the samples of each pass.
class TileSchedule {
 public:
  /// `plan.levels` MUST have one digit 0 to f for each half tile.
  TileSchedule(const TileGrid& grid, const TilePlan& plan);

  /// Returns the samples of all half tiles in `pass`. `pass` MUST begin where the previous pass
  /// ended, and the first pass where the pilot ended.
  TileSamples next(const SampleRange& pass);

 private:
  /// Returns the samples of half tile i in the pass: the next node after the samples that it has,
  /// or none if too few are due.
  SampleRange node_of(std::size_t i, const SampleRange& pass) const;

  TileGrid grid_;
  TilePlan plan_;
  /// For each half of the image (even, odd): true if all its levels are 6 (uniform).
  std::array<bool, 2> uniform_{true, true};
  std::vector<std::uint64_t> taken_;  ///< samples taken so far by each half tile
};

}  // namespace bandsaw
