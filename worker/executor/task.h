#pragma once

// A band that this worker holds, by names of its own: lease ids change when the coordinator is
// restarted, task ids do not.

#include <cstdint>

#include "proto/wire/digest.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::worker {

using TaskId = std::uint64_t;  ///< counts from 1 in this process

struct Task {
  TaskId id = 0;
  std::uint64_t job = 0;
  wire::Digest manifest;
  RenderSettings settings;
  Band band;
  TileSamples tiles = {};  ///< of the band
};

/// What rendering a band took. Where two bands overlap each moment is counted once, for the one
/// that ends first.
struct RenderCost {
  double render_s = 0;  ///< wall clock
  double cpu_s = 0;     ///< summed over threads
};

/// A band whose pixels wait for the coordinator's acknowledgement.
struct FinishedBand {
  Task task;
  BandPixels pixels;
  RenderCost cost;
};

}  // namespace bandsaw::worker
