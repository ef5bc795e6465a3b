#pragma once

// Clean, that is denoised, pictures of finished jobs (renderlib/denoise). The denoiser needs
// guides, which are images of the albedo and the shape of the surfaces. The farm renders each guide
// as a separate job. The filter runs on the coordinator.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/engine/engine.h"
#include "coordinator/rpc/executor.h"
#include "renderlib/base/mutex.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/display.h"
#include "renderlib/image/write_image.h"

namespace bandsaw::coordinator {

/// Thread-safe. One picture is filtered at a time, on one thread, so that users of the dashboard
/// cannot take the machine's CPU from the farm.
class CleanPictures {
 public:
  using Bytes = std::shared_ptr<const std::string>;
  /// Larger pictures are refused: bandsaw watch JOB --denoise cleans them on the user's machine.
  static constexpr std::uint64_t kMaxPixels = std::uint64_t{4} << 20;

  enum class Stage {
    kNone,       ///< not requested, or no longer kept
    kGuides,     ///< the farm renders the guides
    kFiltering,  ///< the filter waits for its turn or runs
    kReady,
    kFailed,
  };
  struct State {
    Stage stage = Stage::kNone;
    double fraction = 0;    ///< part of the guides' work that is done, [0, 1]
    absl::Status why = {};  ///< in stage kFailed
    CleanError error = {};  ///< in stage kReady
  };

  explicit CleanPictures(Engine& engine) : engine_(engine) {}

  /// Submits the jobs that render the guides of a finished job, unless they were submitted before.
  /// The submitted jobs have the priority of the finished job. FAILED_PRECONDITION: the job is not
  /// done, its image cannot be cleaned (scheduler/api/clean_jobs.h), or it is larger than
  /// kMaxPixels. NOT_FOUND: no such job.
  absl::StatusOr<State> start(JobId job) EXCLUDES(mutex_);
  /// Returns the state, and starts the filter when the guides are done. NOT_FOUND: no such job.
  absl::StatusOr<State> state(JobId job) EXCLUDES(mutex_);
  /// Returns a file of the clean picture with at most `most_side` pixels per side.
  /// `most_side` = 0: the picture is not reduced. An EXR file has the layers `raw` and `error`, as
  /// `bandsaw render --denoise` writes it. FAILED_PRECONDITION: the state is not kReady.
  /// For an EXR file, also the errors of result_of() (coordinator/rpc/picture.h), which reads the
  /// layer `raw`.
  absl::StatusOr<Bytes> file(JobId job, std::uint32_t most_side, ImageFormat format)
      EXCLUDES(mutex_);

 private:
  /// The picture and the memory that it takes from Engine::images.
  struct Kept {
    Denoised clean;
    Display display;
    MemoryBudget::Share share;
  };
  struct Entry {
    Stage stage = Stage::kNone;
    /// The jobs that render the guides: first albedo, then shape. For an image of few samples, a
    /// third job renders half of the image's samples again.
    std::vector<JobId> jobs = {};
    absl::Status why = {};
    std::shared_ptr<const Kept> kept = nullptr;
    std::uint64_t used = 0;  ///< number of the last call that used it
  };
  /// Submits the jobs that the picture of a job needs. Returns their ids in the order of
  /// Entry::jobs.
  absl::StatusOr<std::vector<JobId>> submit_jobs(const JobView& of);
  /// Returns the job with the spec's request id, or a new one if that job failed or was cancelled.
  absl::StatusOr<JobId> submit_job(JobSpec spec, std::int32_t priority);
  /// Makes the picture and stores it in its entry. Runs on the executor. `jobs`: as in Entry.
  void filter(const JobView& job, const std::vector<JobId>& jobs) EXCLUDES(mutex_);
  /// Makes the picture from the images of the jobs. RESOURCE_EXHAUSTED: too little memory is left.
  absl::StatusOr<Kept> filtered(const JobView& job, const std::vector<JobId>& jobs);
  /// Drops the pictures that were used least recently until few enough are kept.
  void forget_oldest() REQUIRES(mutex_);

  Engine& engine_;
  Mutex mutex_;
  std::map<JobId, Entry> entries_ GUARDED_BY(mutex_);
  std::uint64_t calls_ GUARDED_BY(mutex_) = 0;
  Mutex encoding_;            ///< held while a file is made
  FileExecutor executor_{1};  // last, because its thread uses the other members
};

}  // namespace bandsaw::coordinator
