#pragma once

// Restart of the coordinator: rebuilds the state from the journal and the bands on disk, and
// continues the jobs.

#include <cstdint>
#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"
#include "coordinator/scheduler/jobs/sequences.h"
#include "coordinator/scheduler/jobs/stored_bands.h"
#include "coordinator/scheduler/trust/result_comparison.h"

namespace bandsaw::coordinator {

class Restart {
 public:
  Restart(Context& context, ReconnectBarrier& barrier, PassPlanner& planner,
          JobLifecycle& lifecycle, StoredBands& bands, ResultComparison& comparison,
          Sequences& sequences)
      : context_(context),
        barrier_(barrier),
        planner_(planner),
        lifecycle_(lifecycle),
        bands_(bands),
        comparison_(comparison),
        sequences_(sequences) {}

  /// Adds a band that was found on disk: its rows become stored, unless the worker process that
  /// rendered them is quarantined.
  void add_band(const input::BandStored& band);
  /// Notes for users that this many bytes of the job's band log (the file of its stored bands) are
  /// damaged.
  void note_damage(JobId id, std::uint64_t bytes);
  /// Ends the replay in four steps. Begins the reconnect barrier: nothing is leased until the
  /// former workers are back. For each row for which two machines returned different pixels, opens
  /// an audit again (the row is rendered once more, to compare). Compares the bands that were
  /// rendered twice. Continues each job and sequence; one that was begun with another pixel version
  /// (a number that changes whenever rendered pixels change) fails.
  void finish();

 private:
  void compare_duplicates();
  void resume(Job& job);

  Context& context_;
  ReconnectBarrier& barrier_;
  PassPlanner& planner_;
  JobLifecycle& lifecycle_;
  StoredBands& bands_;
  ResultComparison& comparison_;
  Sequences& sequences_;
  /// Bands with rows that an earlier band of the replay stored already. A comparison can retract
  /// rows, and the film (the sums of all stored bands) must be complete before rows are retracted.
  /// So these bands are compared once all bands are replayed.
  std::vector<input::BandStored> duplicates_;
};

}  // namespace bandsaw::coordinator
