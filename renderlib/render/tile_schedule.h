#pragma once

// When half tiles take what a plan gives them.

#include <array>
#include <cstdint>
#include <vector>

#include "renderlib/render/adaptive_plan.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw {

/// Which samples half tiles take in which pass after the pilot.
///
/// A half tile has the first samples of its own sequence, 4, 5, 6 or 7 quarters of 2^k: samples
/// left out here and there would be no nets of Sobol' points, and where an image is smooth its
/// error falls by nets. It takes the next quarter when its share is due; which of two half tiles of
/// equal shares does so earlier is dealt out evenly over the image, so that the mean is what is
/// due. A half of the image whose levels are all 6 takes the passes as they are.
class TileSchedule {
 public:
  /// `plan.levels` has one digit 0 … f a half tile.
  TileSchedule(const TileGrid& grid, const TilePlan& plan);

  /// The pass that follows the last.
  TileSamples next(const SampleRange& pass);

 private:
  /// What half tile i takes: the longest node after what it has, or nothing.
  SampleRange node_of(std::size_t i, const SampleRange& pass) const;

  TileGrid grid_;
  TilePlan plan_;
  std::array<bool, 2> even_{true, true};  ///< each half of the image: all levels are 6
  std::vector<std::uint64_t> taken_;      ///< samples of each half tile
};

}  // namespace bandsaw
