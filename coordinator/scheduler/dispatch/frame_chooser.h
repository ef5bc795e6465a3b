#pragma once

// Chooses the frame of a sequence from which a worker gets its next band. Each frame is rendered by
// a job of its own, its frame job. While the frames that nobody renders are at least as many as the
// workers, each worker renders a frame alone. After that, workers without a frame render bands of
// the frames of other workers.

#include <cstddef>
#include <map>
#include <set>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class FrameChooser {
 public:
  explicit FrameChooser(Context& context) : context_(context) {}

  /// Returns the running frame jobs of a sequence in the order in which they are offered to the
  /// worker: the frame that it renders already, frames that no eligible worker renders, frames of
  /// others. Sets Job::alone of each frame job to true if only one worker is to render it, else to
  /// false. Copies the costs and rates measured in earlier frames to new frame jobs.
  std::vector<Job*> order_for(const Worker& worker, const Sequence& sequence);
  /// MUST be called when a worker is granted a band of a frame job.
  void joined(const Worker& worker, const Job& job);

 private:
  /// Returns true if an eligible worker (Worker::eligible) renders the frame.
  bool is_being_rendered(JobId job) const;
  void forget_final();

  Context& context_;
  std::map<WorkerId, JobId> frame_of_;              ///< the frame job that a worker renders
  std::map<JobId, std::set<WorkerId>> workers_of_;  ///< the workers that render a frame job
};

}  // namespace bandsaw::coordinator
