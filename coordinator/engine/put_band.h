#pragma once

// A band on its way from a worker to the disk and the film.

#include <cstdint>
#include <string>

#include "coordinator/engine/answer.h"
#include "coordinator/engine/engine.h"
#include "coordinator/engine/memory_budget.h"
#include "coordinator/scheduler/api/ids.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {

struct PutBand {
  JobId job = 0;
  std::uint64_t work = 0;      ///< that it says it is of (renderlib/render/work_hash.h); 0: nothing
  std::string instance;        ///< of the worker
  std::uint64_t renderer = 0;  ///< of it (scheduler/api/worker_process.h)
  BandPixels pixels;
  std::string worker;      ///< as action::AddToFilm tells it
  TileSamples tiles = {};  ///< likewise
  double render_s = 0;
  double cpu_s = 0;
  bool written = false;
  std::uint64_t offset = 0;  ///< of its record in the job's log, once it is written
  Answer<BandOutcome> answer;
  MemoryBudget::Share share;
};

}  // namespace bandsaw::coordinator
