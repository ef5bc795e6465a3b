#pragma once

// The words of the core: jobs, workers, leases, and what is shown of them. Plain values; no clock,
// thread, socket or SQL.

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "coordinator/core/error_curve.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/work_hash.h"

namespace bandsaw::coordinator {

using JobId = std::uint64_t;    ///< counts from 1, never used again
using LeaseId = std::uint64_t;  ///< unique within one life of the coordinator
using SessionId =
    std::uint64_t;  ///< one stream of one worker; unique within one life of the coordinator

/// Seconds since an arbitrary start; only differences mean anything.
using Time = double;

/// 64 lower-case hexadecimal digits.
using DigestHex = std::string;

/// A job is done after this many samples a pixel.
struct StopAtSamples {
  std::uint64_t samples = 0;  ///< [1, kMaxSamples]
  friend bool operator==(const StopAtSamples&, const StopAtSamples&) = default;
};
/// … or once the estimated relative RMSE of the image is this small.
struct StopAtError {
  double relative_rmse = 0;  ///< > 0; 0.01 is 1 %
  std::uint64_t max_samples = kMaxSamples;
  bool adaptive = false;  ///< more samples where there is more noise (render/adaptive_plan.h)
  friend bool operator==(const StopAtError&, const StopAtError&) = default;
};
/// … or at the last complete pass before this much time since its first lease.
struct StopAtTime {
  double seconds = 0;  ///< > 0
  std::uint64_t max_samples = kMaxSamples;
  friend bool operator==(const StopAtTime&, const StopAtTime&) = default;
};
using StopRule = std::variant<StopAtSamples, StopAtError, StopAtTime>;

inline bool is_adaptive(const StopRule& rule) {
  const auto* until = std::get_if<StopAtError>(&rule);
  return until != nullptr && until->adaptive;
}

struct JobSpec {
  std::string request_id;  ///< the submitter's key: the same id is the same job
  std::string name;
  DigestHex manifest;
  RenderSettings settings;
  StopRule stop;
  /// Whether pixels that say they are of `work` (renderlib/render/work_hash.h; 0: nothing) may be
  /// of it: the job's number alone may be that of another job by now.
  bool may_be(std::uint64_t work) const {
    return work == 0 || work == work_hash(manifest, settings);
  }
  friend bool operator==(const JobSpec&, const JobSpec&) = default;
};

/// Jobs of higher priority are leased first, those of equal priority in their order.
inline constexpr std::int32_t kMostPriority = 1'000;

enum class JobState {
  kRunning,    ///< has work left
  kPaused,     ///< not leased until resumed; the reason says why
  kFinishing,  ///< every pixel is there; the result is being written
  kDone,       ///< the result can be fetched; final
  kFailed,     ///< the reason says why; final
  kCancelled,  ///< final
};
constexpr bool is_final(JobState s) {
  return s == JobState::kDone || s == JobState::kFailed || s == JobState::kCancelled;
}

/// What a worker said of itself.
struct WorkerHello {
  std::string instance;  ///< unique to its process, kept over reconnects
  std::string name;
  std::string address;
  std::string build;
  std::uint32_t protocol = 0;
  std::uint32_t pixel_version = 0;
  std::uint64_t canary = 0;
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 2;
  /// Leases from before a reconnect.
  struct Held {
    JobId job = 0;
    Band band;
    LeaseId lease = 0;
    std::string epoch;
    bool finished = false;
    std::uint64_t work = 0;  ///< renderlib/render/work_hash.h; 0: not said
  };
  std::vector<Held> held;
};

struct LeaseProgress {
  LeaseId lease = 0;
  std::uint32_t rows_done = 0;
  bool preparing = false;
  std::uint64_t prepared = 0;  ///< grows while the scene is being fetched or built
};

// ---- what is shown ----

struct JobWorkerView {
  std::string name;
  std::uint32_t threads = 0;
  double samples_per_s = 0;
  RowRange rows;  ///< of its oldest lease
  std::string state;
};

/// What a worker rendered of the image.
struct WorkerShare {
  std::uint64_t renderer = 0;  ///< names the worker in all lives of the coordinator
  std::string name;            ///< empty: it was not heard of since the coordinator was started
  std::uint64_t samples = 0;   ///< pixel samples
  double cpu_s = 0;            ///< summed over its threads
  friend bool operator==(const WorkerShare&, const WorkerShare&) = default;
};

struct JobView {
  JobId id = 0;
  JobSpec spec;
  JobState state = JobState::kRunning;
  std::string reason;
  double fraction = 0;
  double elapsed_s = 0;
  double remaining_s = -1;  ///< negative: not known
  double samples_per_s = 0;
  std::uint64_t samples_done = 0;       ///< pixel samples stored
  std::uint64_t samples_per_pixel = 0;  ///< of the complete passes
  double error = -1;                    ///< negative: not known
  Counters counters;
  double cpu_s = 0;
  std::uint32_t workers_used = 0;
  std::int32_t priority = 0;
  std::string log_of;            ///< of a failed job: the worker that failed last …
  std::vector<std::string> log;  ///< … and the last lines of its log
  /// Bands given to idle workers though others had them; what was rendered twice by it is counted
  /// in no other figure.
  std::uint64_t bands_copied = 0;
  /// Bands that two machines rendered to the same digests. Of a job that is over: 0.
  std::uint64_t bands_audited = 0;
  std::vector<JobWorkerView> workers;
  ErrorCurve curve;                 ///< in lists of jobs: empty
  std::vector<WorkerShare> shares;  ///< of a final job; in lists of jobs: empty
};

struct WorkerView {
  std::string name;
  std::string state;
  std::string reason;
  std::string address;
  std::string build;
  std::uint32_t threads = 0;
  double samples_per_s = 0;
  JobId job = 0;
  double connected_s = 0;
};

}  // namespace bandsaw::coordinator
