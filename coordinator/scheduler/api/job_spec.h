#pragma once

// The specification of a job by its submitter, and the states of a job. A job is rendered in
// passes: ranges of samples, each for the whole image.

#include <cstdint>
#include <string>
#include <variant>

#include "coordinator/scheduler/api/ids.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/work_hash.h"

namespace bandsaw::coordinator {

/// The job ends after this many samples per pixel.
struct StopAtSamples {
  std::uint64_t samples = 0;  ///< [1, kMaxSamples]
  friend bool operator==(const StopAtSamples&, const StopAtSamples&) = default;
};
/// The job ends once the estimated relative RMSE of the image is at most `relative_rmse`.
struct StopAtError {
  double relative_rmse = 0;  ///< > 0; 0.01 is 1 %
  std::uint64_t max_samples = kMaxSamples;
  /// If true, parts of the image with more noise get more samples
  /// (renderlib/render/adaptive_plan.h).
  bool adaptive = false;
  friend bool operator==(const StopAtError&, const StopAtError&) = default;
};
/// The job ends when this much time has passed since its first lease. The image has the passes that
/// are complete at that time. If no pass is complete by then, the job ends once its first pass is
/// complete.
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

/// A job as its submitter described it. Also the spec of a frame job, which renders one frame of a
/// sequence.
struct JobSpec {
  std::string request_id;  ///< chosen by the submitter: the same id means the same job
  std::string name;
  DigestHex manifest;  ///< digest of the manifest of its scene package (manifest and arrays)
  RenderSettings settings;
  StopRule stop;
  JobId sequence = 0;     ///< the sequence of a frame job (sequence_spec.h); 0: none
  FrameNumber frame = 0;  ///< its number in the sequence
  /// Bytes of the package, the manifest included. This number follows from the manifest, so
  /// operator== does not compare it. 0: unknown, because an earlier version of the coordinator
  /// journalled the job without it.
  std::uint64_t package_bytes = 0;
  /// Returns true if a band (rows and samples that a worker rendered) which is labelled with the
  /// hash `work` can belong to this job (renderlib/render/work_hash.h). The job id alone is not
  /// enough, because ids are reused after a reset of the data folder. `work` is 0 if the band is
  /// not labelled; such a band is accepted.
  bool may_be(std::uint64_t work) const {
    return work == 0 || work == work_hash(manifest, settings);
  }
  friend bool operator==(const JobSpec& a, const JobSpec& b) {
    return a.request_id == b.request_id && a.name == b.name && a.manifest == b.manifest &&
           a.settings == b.settings && a.stop == b.stop && a.sequence == b.sequence &&
           a.frame == b.frame;
  }
};

/// Priorities are in [-kMaxPriority, kMaxPriority]. Jobs of higher priority are leased first, jobs
/// of equal priority in the order of their ids.
inline constexpr std::int32_t kMaxPriority = 1'000;

enum class JobState {
  kRunning,    ///< has work left
  kPaused,     ///< nothing is leased until it is resumed; the job's reason says why
  kFinishing,  ///< every pixel is rendered; the result is being written
  kDone,       ///< the result can be fetched; final
  kFailed,     ///< the job's reason says why; final
  kCancelled,  ///< final
};
constexpr bool is_final(JobState s) {
  return s == JobState::kDone || s == JobState::kFailed || s == JobState::kCancelled;
}

/// Returns the word for a state in tables, logs, JSON and metrics.
constexpr const char* state_name(JobState state) {
  switch (state) {
    case JobState::kRunning:
      return "running";
    case JobState::kPaused:
      return "paused";
    case JobState::kFinishing:
      return "finishing";
    case JobState::kDone:
      return "done";
    case JobState::kFailed:
      return "failed";
    case JobState::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

}  // namespace bandsaw::coordinator
