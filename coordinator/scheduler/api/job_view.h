#pragma once

// Jobs and workers as commands and the dashboard display them (scheduler/views fills them in).

#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/error_curve.h"
#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/sequence_spec.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// A worker that has leases of a job.
struct JobWorkerView {
  std::string name;
  std::uint32_t threads = 0;
  double samples_per_s = 0;  ///< pixel samples, on this job
  RowRange rows;             ///< rows of its oldest lease of the job
  std::string state;         ///< what it is doing, for example "rendering"
};

/// The part of an image that one worker process rendered.
struct WorkerShare {
  WorkerProcessId process = 0;
  std::string name;           ///< empty: not connected in this run of the coordinator
  std::uint64_t samples = 0;  ///< pixel samples
  double cpu_s = 0;           ///< summed over its threads
  friend bool operator==(const WorkerShare&, const WorkerShare&) = default;
};

/// Selects the jobs of a list: those with ids above `after`, at most `most` of them, lowest first.
struct JobPage {
  JobId after = 0;
  std::size_t most = std::numeric_limits<std::size_t>::max();
};

/// A job, or a sequence with the sums over its frames.
struct JobView {
  JobId id = 0;
  JobSpec spec;
  JobState state = JobState::kRunning;
  std::string reason;
  double fraction = 0;  ///< part of the work that is done, [0, 1]
  /// Seconds since its first lease. The times between runs of the coordinator do not count. The
  /// times in which the job was paused do not count either. For a sequence, a pause counts unless a
  /// user requested it.
  double elapsed_s = 0;
  double remaining_s = -1;              ///< negative: unknown
  double samples_per_s = 0;             ///< pixel samples, recently; 0 for a final job
  std::uint64_t samples_done = 0;       ///< pixel samples stored
  std::uint64_t samples_per_pixel = 0;  ///< samples per pixel of the complete passes
  double error = -1;                    ///< relative RMSE plus its margin; negative: unknown
  Counters counters;
  double cpu_s = 0;
  std::uint32_t workers_used = 0;
  std::int32_t priority = 0;
  std::string log_of;            ///< for a failed job, the worker that failed last
  std::vector<std::string> log;  ///< the last lines of that worker's log
  /// Backup tasks (second leases of late bands) that were granted. The duplicate work is counted in
  /// no other number.
  std::uint64_t bands_copied = 0;
  /// Bands that two machines rendered with equal digests. 0 once the job is final.
  std::uint64_t bands_audited = 0;
  std::vector<JobWorkerView> workers;
  ErrorCurve curve;                 ///< the error after each pass; empty in lists of jobs
  std::vector<WorkerShare> shares;  ///< for a final job; empty in lists of jobs
  FrameCounts frames;               ///< for a sequence; all 0 for other jobs
  /// Returns true if this is a sequence.
  bool has_frames() const { return frames.all() > 0; }
};

/// The scene packages and result files that must be kept on disk for a job.
struct KeptJob {
  JobId id = 0;
  bool final = false;
  std::vector<DigestHex> manifests;  ///< manifests of its packages
  std::vector<JobId> frame_jobs;     ///< for a sequence: its frame jobs, whose files it owns
};

/// A worker that is connected, has left, was refused, or is under quarantine.
struct WorkerView {
  std::string name;
  std::string state;   ///< idle, rendering, draining, lost, quarantined or refused
  std::string reason;  ///< why it is in this state or gets no work; may be empty
  std::string address;
  std::string build;  ///< version, compiler and CPU of its program
  std::uint32_t threads = 0;
  double samples_per_s = 0;  ///< pixel samples
  JobId job = 0;             ///< of the lease that it renders; 0: none
  double connected_s = 0;    ///< since it connected; 0: not connected
  bool browser = false;      ///< it renders in a browser
};

}  // namespace bandsaw::coordinator
