#pragma once

// A task is a leased band (a range of rows and samples of a job's image) with all that is needed to
// render it. The worker itself numbers its tasks, because lease ids change when the coordinator is
// restarted.

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
  wire::Digest manifest;  ///< of the scene package
  RenderSettings settings;
  Band band;
  /// In adaptive sampling, the samples that each half tile (half of the pixels of a tile) of the
  /// band takes. Empty: all pixels take the samples of the band.
  TileSamples tiles = {};
};

/// Cost of rendering a band. Time in which two bands are rendered at once is counted only once: for
/// the band that ends first.
struct RenderCost {
  double render_s = 0;  ///< wall clock
  double cpu_s = 0;     ///< summed over threads
};

/// A rendered band whose pixels are not yet acknowledged by the coordinator.
struct FinishedBand {
  Task task;
  BandPixels pixels;
  RenderCost cost;
};

}  // namespace bandsaw::worker
