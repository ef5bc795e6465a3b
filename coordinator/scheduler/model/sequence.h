#pragma once

// One sequence (a job of many frames): its frames and their states. Each frame is rendered by a job
// of its own, its frame job. An epoch is one run of the coordinator.

#include <cstddef>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/sequence_spec.h"
#include "coordinator/scheduler/model/job.h"
#include "coordinator/scheduler/model/rates.h"
#include "coordinator/scheduler/model/row_costs.h"
#include "coordinator/scheduler/model/work_clock.h"

namespace bandsaw::coordinator {

class Sequence {
 public:
  /// A frame has failed for good when this many of its jobs have failed.
  static constexpr std::uint32_t kTries = 2;

  struct Frame {
    FrameNumber number = 0;
    DigestHex manifest;  ///< empty: not known yet
    FrameState state = FrameState::kExpected;
    JobId job = 0;               ///< its frame job; 0: none
    std::uint32_t failures = 0;  ///< number of its earlier jobs that failed
    std::string reason;          ///< reason of the last failure; empty: none
    /// The changes of all frames in this epoch are numbered from 1 on. This is the number of the
    /// frame's last change; 0: it has not changed.
    std::uint64_t changed = 0;
    std::uint64_t package_bytes = 0;  ///< bytes of its scene package; 0: unknown
  };

  Sequence(JobId id, SequenceSpec spec, std::uint32_t pixel_version);

  /// Returns nullptr if it has no frame with this number.
  const Frame* frame(FrameNumber number) const;
  const std::vector<Frame>& frames() const { return frames_; }
  /// Returns the frames in a state, ascending.
  std::vector<FrameNumber> numbers(FrameState state) const;
  const FrameCounts& counts() const { return counts_; }
  /// Returns the frame that is rendered next; nullptr: none waits.
  const Frame* next_waiting() const;
  /// Returns the frame jobs that are not final, ascending.
  const std::set<JobId>& open_jobs() const { return open_jobs_; }
  /// Returns a frame whose job has failed and that is to be tried again; nullptr: none.
  const Frame* next_to_retry() const;
  /// Returns the largest Frame::changed.
  std::uint64_t changes() const { return changes_; }
  /// Returns the specification of the job of a frame that has a manifest.
  JobSpec job_spec(const Frame& frame) const;
  /// Returns the seconds for which the sequence has been worked on, in all epochs. The time in
  /// which a user paused it does not count.
  double elapsed(Time now) const;
  /// Begins a new measurement of the pace of the frames. Called when an epoch begins, or when
  /// failed frames of a final sequence are rendered again. Stops the clock at the journalled time.
  void restart_clock();

  // Only Context::apply calls wait(), start() and end(). They do nothing if there is no such frame.
  /// Makes the frame wait to be rendered, because its scene is known now or because it is tried
  /// again. `failures`: number of its jobs that failed. `reason`: reason of the last failure.
  void wait(const FrameScene& scene, std::uint32_t failures, const std::string& reason);
  /// Notes that `job`, the frame job of the frame, was made.
  void start(FrameNumber number, JobId job);
  /// Ends the frame whose frame job is `job`. REQUIRES: is_final(job.state).
  void end(const Job& job);

  JobId id = 0;
  SequenceSpec spec;
  std::uint32_t pixel_version = 0;
  JobState state = JobState::kRunning;  ///< never kFinishing
  std::int32_t priority = 0;
  bool held = false;               ///< paused by a user
  std::string reason;              ///< why the sequence is in its state
  double elapsed_noted = 0;        ///< seconds: the last elapsed() in the journal
  WorkClock clock;                 ///< runs since the first lease after restart_clock() or a pause
  std::size_t done_before = 0;     ///< frames that were done at the last restart_clock()
  double elapsed_then = 0;         ///< seconds: elapsed() at the last restart_clock()
  Totals done;                     ///< samples, counters and CPU time of the frames that are done
  double worst_error = -1;         ///< largest error of the frames that are done; negative: unknown
  std::uint32_t workers_used = 0;  ///< largest number of workers of a frame that is done
  /// Row costs and work rate of the frame that was done last; the next frame jobs start with them.
  CostMap cost;
  MeanRate work_rate;

 private:
  Frame* find(FrameNumber number);
  /// Sets the state of the frame, and updates the counts and the lists of waiting frames.
  void change(Frame& frame, FrameState state);

  std::vector<Frame> frames_;  ///< ascending by number
  FrameCounts counts_;
  std::set<FrameNumber> waiting_;
  std::set<FrameNumber> to_retry_;
  std::set<JobId> open_jobs_;
  std::uint64_t changes_ = 0;
};

}  // namespace bandsaw::coordinator
