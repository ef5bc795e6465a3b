#pragma once

// A band that this worker holds, under an id of its own: lease ids change when the coordinator is
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
  TileSamples tiles = {};  ///< samples of the band's half tiles
};

/// Cost of rendering a band. While two bands overlap, the time is counted once, for the one that
/// ends first.
struct RenderCost {
  double render_s = 0;  ///< wall clock
  double cpu_s = 0;     ///< summed over threads
};

/// A band whose pixels are not acknowledged by the coordinator.
struct FinishedBand {
  Task task;
  BandPixels pixels;
  RenderCost cost;
};

}  // namespace bandsaw::worker
