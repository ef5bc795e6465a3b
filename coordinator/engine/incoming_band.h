#pragma once

// A band on its way from a worker to the disk and the film. A band is a range of rows and samples
// of a job; the film holds the sums of all pixels of the job.

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "coordinator/engine/answer.h"
#include "coordinator/engine/memory_budget.h"
#include "coordinator/scheduler/api/job_view.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {

/// The answer to a worker's upload of a band.
enum class BandOutcome {
  kStored,     ///< it is on disk and in the journal
  kDuplicate,  ///< all of its rows were stored already
  kUnwanted    ///< the job is over, or the band is not part of it
};

/// Returns the error for a band that does not fit into the budget Engine::bands():
/// RESOURCE_EXHAUSTED.
inline absl::Status no_memory_for_band() {
  return absl::ResourceExhaustedError(
      "the coordinator holds as many bands in memory as it may; send this one again soon");
}

struct IncomingBand {
  JobId job = 0;
  /// Hash of the scene and settings for which the band was rendered, as the worker reports it
  /// (renderlib/render/work_hash.h); 0: unknown.
  std::uint64_t work = 0;
  std::string instance;       ///< name that the worker process chose for itself at its start
  bool browser = false;       ///< a browser sent it
  std::uint64_t process = 0;  ///< id of the worker process, a hash of its instance name
  BandPixels pixels;
  std::string worker;  ///< name of the worker, from action::AddToFilm
  /// How many samples each half tile of the band takes, from action::AddToFilm. A half tile has
  /// half of the pixels of a square of 16 x 16.
  TileSamples tiles = {};
  double render_s = 0;       ///< seconds in which the worker rendered it
  double cpu_s = 0;          ///< CPU seconds of the worker's threads
  bool written = false;      ///< it is in the job's log; false: all of its rows were stored already
  std::uint64_t offset = 0;  ///< offset of its record in the job's log, once it is written
  Answer<BandOutcome> answer;  ///< to the worker
  MemoryBudget::Share share;   ///< memory of the pixels, from Engine::bands()
};

}  // namespace bandsaw::coordinator
