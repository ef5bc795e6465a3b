#pragma once

// The watchers of jobs: callbacks that are called when a job changes, for `watch` and the
// dashboard.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

/// Not thread-safe; the scheduler's thread uses it.
class Watchers {
 public:
  /// Takes the new state of the job. Returns false if it wants no further calls.
  using Changed = std::function<bool(absl::StatusOr<JobView>)>;
  /// Returns the state of a job; std::nullopt: there is no such job.
  using ViewOf = absl::FunctionRef<std::optional<JobView>(JobId)>;

  /// Adds a watcher and calls it with the present state, `view`. If `view` is std::nullopt, the
  /// watcher is called with NOT_FOUND and is not added. A final state ends the watch.
  void add(JobId job, const std::optional<JobView>& view, Changed changed, Time now);

  /// Calls the watchers of changed jobs, at most ten times per second and job, and all watchers at
  /// least once a second. A final state is always delivered, and ends the watch. Delivers NOT_FOUND
  /// if the job was forgotten. `hold_final`: if true, final states wait for a later call, because
  /// they are not on disk yet.
  void update(ViewOf view_of, bool hold_final, Time now);

 private:
  struct Watched {
    JobView sent;      ///< the state that was delivered last
    Time sent_at = 0;  ///< when it was delivered
    Time checked_at = 0;
    std::vector<Changed> watchers;
  };
  std::map<JobId, Watched> jobs_;
};

}  // namespace bandsaw::coordinator
