#pragma once

// Records of the journal, the coordinator's log of decisions on disk. The scheduler's durable state
// changes only by applying a record, whether the record is new or replayed after a restart.
//
// A pass is a range of samples of the whole image; a band is a range of rows and samples, which one
// worker renders; a frame job renders one frame of a sequence. More terms: proto/README.md,
// Glossary.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/scheduler/api/error_curve.h"
#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/job_view.h"
#include "coordinator/scheduler/api/sequence_spec.h"
#include "renderlib/render/adaptive_plan.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

namespace record {
/// A user submitted a job, or the scheduler made the job of a frame.
struct JobAdded {
  JobId job = 0;
  JobSpec spec;
  std::uint32_t pixel_version = 0;  ///< coordinator's version at that time; 0: not journalled
};
/// A pass over `samples` of the whole image is planned. It is journalled because the passes of jobs
/// with an error target or a time limit depend on measurements.
struct PassPlanned {
  JobId job = 0;
  SampleRange samples;
};
/// From the next pass on, the half tiles of an adaptive job take the numbers of samples of this
/// plan. A half tile has half of the pixels of a 16 x 16 tile.
struct TilesPlanned {
  JobId job = 0;
  TilePlan plan;
};
/// The job ends after this many samples per pixel; there will be no further pass.
struct SamplesFixed {
  JobId job = 0;
  std::uint64_t samples = 0;
};
/// The state of a job or of a sequence. In PriorityChanged, HoldChanged, TimeSpent and
/// JobForgotten, `job` may be a sequence as well.
struct StateChanged {
  JobId job = 0;
  JobState state = JobState::kRunning;
  std::string reason;
};
/// A job that always had priority 0 has no such record.
struct PriorityChanged {
  JobId job = 0;
  std::int32_t priority = 0;
};
/// A user paused the job (or resumed it); only a user can resume a held job.
struct HoldChanged {
  JobId job = 0;
  bool held = false;
};
/// Time that the job has been worked on, in all runs of the coordinator together. The last record
/// of a job counts.
struct TimeSpent {
  JobId job = 0;
  double elapsed_s = 0;
};
/// Totals of a job that is about to become final. They are kept because the job's bands are dropped
/// when it becomes final.
struct JobSummary {
  JobId job = 0;
  double elapsed_s = 0;
  double cpu_s = 0;
  std::uint32_t workers_used = 0;
  std::uint64_t samples = 0;            ///< pixel samples stored
  std::uint64_t samples_per_pixel = 0;  ///< samples per pixel of the complete passes
  double error = -1;                    ///< negative: unknown
  Counters counters;
};
/// The error of the image after a pass.
struct ErrorMeasured {
  JobId job = 0;
  ErrorPoint point;
};
/// A worker's share of a job that is about to become final; one record per worker.
struct ShareCounted {
  JobId job = 0;
  WorkerShare share;
};
/// The last lines of the log of the worker that failed the job.
struct FailureLog {
  JobId job = 0;
  std::string worker;
  std::vector<std::string> log;
};
/// A final job is removed; its id is never reused.
struct JobForgotten {
  JobId job = 0;
};
/// A worker process connected. After a restart the scheduler waits for the processes that were
/// connected, because they may hold finished bands.
struct WorkerJoined {
  std::string instance;
  /// It renders in a browser; its bands are audited at the rate of browsers.
  bool browser = false;
};
/// A worker process disconnected.
struct WorkerLeft {
  std::string instance;
};
/// A second machine returned the same digests for rows that `process` had stored. So these rows are
/// assumed to be right.
struct BandAudited {
  JobId job = 0;
  Band band;
  WorkerProcessId process = 0;
};
/// The pixels of the band that `process` had stored are damaged on disk. The band is rendered
/// again. An earlier BandAudited of the band does not hold for its new pixels.
struct BandLost {
  JobId job = 0;
  Band band;
  WorkerProcessId process = 0;
};
/// A second machine returned a digest for a row that differs from the stored digest. The job must
/// not end before it is known which digest is right.
struct RowDisputed {
  /// The result of one machine for the row.
  struct Claim {
    WorkerProcessId process = 0;
    std::string machine;  ///< name that its worker reports; for a browser, its instance
    std::uint64_t digest = 0;
    friend bool operator==(const Claim&, const Claim&) = default;
  };
  JobId job = 0;
  Band band;  ///< one row
  Claim stored;
  Claim other;
  friend bool operator==(const RowDisputed&, const RowDisputed&) = default;
};
/// The error measured so far is void, because some pixels from which it was measured have been
/// retracted.
struct ErrorForgotten {
  JobId job = 0;
};
/// A machine returned wrong pixels, or a user quarantined it. All that this worker process rendered
/// is void, and no worker that reports the name gets work.
struct WorkerQuarantined {
  WorkerProcessId process = 0;
  std::string name;  ///< the name that the worker reports; empty: unknown
  std::string reason;
  bool browser = false;
};
/// A user lifted the quarantine of all processes with this name.
struct QuarantineLifted {
  std::string name;
};
/// A user submitted a sequence; `job` is its id.
struct SequenceAdded {
  JobId job = 0;
  SequenceSpec spec;
  std::uint32_t pixel_version = 0;  ///< coordinator's version at that time
};
/// A frame of the sequence `job` waits to be rendered: its scene has arrived, or it is to be tried
/// again. Its earlier frame job, if any, no longer belongs to it.
struct FrameWaits {
  JobId job = 0;
  FrameNumber frame = 0;
  DigestHex manifest;
  std::uint64_t package_bytes = 0;  ///< size of its scene package; 0: unknown
  std::uint32_t failures = 0;       ///< number of its jobs that have failed
  std::string reason;               ///< reason of the last failure
};
}  // namespace record

using Record =
    std::variant<record::JobAdded, record::PassPlanned, record::TilesPlanned, record::SamplesFixed,
                 record::StateChanged, record::PriorityChanged, record::HoldChanged,
                 record::TimeSpent, record::JobSummary, record::ErrorMeasured, record::ShareCounted,
                 record::FailureLog, record::JobForgotten, record::WorkerJoined, record::WorkerLeft,
                 record::BandAudited, record::BandLost, record::RowDisputed, record::ErrorForgotten,
                 record::WorkerQuarantined, record::QuarantineLifted, record::SequenceAdded,
                 record::FrameWaits>;

}  // namespace bandsaw::coordinator
