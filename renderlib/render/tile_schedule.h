#pragma once

// Schedule of adaptive sampling. The image is divided into tiles of 16 x 16 pixels, and a fixed
// pattern divides the pixels of each tile into an even and an odd half tile (tile_samples.h). The
// first samples, which all pixels take, are the pilot. From the pilot, a plan (adaptive_plan.h) is
// made, which gives each half tile a share: the number of its samples divided by the number that it
// has with uniform sampling. The schedule decides in which passes the half tiles take these
// samples. A pass is one range of samples, rendered for the whole image. The coordinator makes one
// schedule for each adaptive job.

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
/// quarters of 2^k. If samples were left out, the remaining ones would not form nets of Sobol'
/// points. Complete nets matter, because in smooth regions the error falls with each complete net.
///
/// In a pass, a half tile takes one node or no samples. A node is an aligned range of 2^k blocks of
/// 8 samples (band.h). A half tile takes its next node when it is far enough behind the plan. Half
/// tiles of equal share take their nodes in different passes, spread evenly over the image. So on
/// average the half tiles have as many samples as the plan gives.
///
/// The plan states the share of each half tile as a level from 0 to 15. Level 6 stands for as many
/// samples as uniform sampling takes. All even half tiles are one half of the image, and all odd
/// half tiles are the other half. If all levels of one half of the image are 6, the half tiles of
/// this half take the samples of each pass.
class TileSchedule {
 public:
  /// `plan.levels` MUST have one digit, 0 to f, for each half tile of the grid.
  TileSchedule(const TileGrid& grid, const TilePlan& plan);

  /// Returns the samples of all half tiles in `pass`. The first pass MUST begin where the
  /// pilot ended, and each further pass where the previous pass ended.
  TileSamples next(const SampleRange& pass);

 private:
  /// Returns the samples of half tile i in the pass: the next node after the samples that the half
  /// tile has, or an empty range if it is not far enough behind the plan or would have more
  /// than kMaxSamples.
  SampleRange node_of(std::size_t i, const SampleRange& pass) const;

  TileGrid grid_;
  TilePlan plan_;
  /// For each half of the image (even, odd): true if all its levels are 6 (uniform).
  std::array<bool, 2> uniform_{true, true};
  std::vector<std::uint64_t> taken_;  ///< samples taken so far by each half tile
};

}  // namespace bandsaw
