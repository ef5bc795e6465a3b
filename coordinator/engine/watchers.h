#pragma once

// Who watches which job, and when each is told.

#include <functional>
#include <map>
#include <optional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/job_view.h"

namespace bandsaw::coordinator {

/// Used by one thread.
class Watchers {
 public:
  using Changed = std::function<bool(absl::StatusOr<JobView>)>;
  using ViewOf = absl::FunctionRef<std::optional<JobView>(JobId)>;

  /// Tells the state now; NOT_FOUND when `view` is nothing. A final state ends the watch.
  void add(JobId job, const std::optional<JobView>& view, Changed changed, Time now);

  /// Tells everybody whose job changed, at most ten times a second a job, and everybody at least
  /// once a second; a final state always, and last; NOT_FOUND when the job was forgotten.
  /// `hold_final`: not yet, it is not durable.
  void update(ViewOf view_of, bool hold_final, Time now);

 private:
  struct Watched {
    JobView told;      ///< what was told last
    Time told_at = 0;  ///< when
    Time looked_at = 0;
    std::vector<Changed> watchers;
  };
  std::map<JobId, Watched> jobs_;
};

}  // namespace bandsaw::coordinator
