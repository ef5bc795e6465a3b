#pragma once

// The part of a worker that renders. It loads the scenes of leased bands (a band is a range of rows
// and samples), renders the bands, sends their pixels to the coordinator, and reports each event to
// the session. The Daemon has one BandPipeline.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderlib/base/pool.h"
#include "worker/cache/blob_cache.h"
#include "worker/executor/executor.h"
#include "worker/executor/load_package.h"
#include "worker/executor/uploader.h"
#include "worker/session/coordinator_api.h"
#include "worker/session/shared_session.h"

namespace bandsaw::worker {

/// Returns the last lines of this process's log, to be sent with a failed band.
using LogTail = std::function<std::vector<std::string>()>;

class BandPipeline {
 public:
  /// `kernel`: the code that renders the scenes, one of kernels() (renderlib/render/kernel.h);
  /// nullptr: the first of them. `log_tail` may be nullptr.
  /// `seed`: the seed of the random waits before a band is sent again. `calls` and `session` MUST
  /// outlive the pipeline.
  BandPipeline(SharedSession& session, std::unique_ptr<BlobCache> cache, int threads,
               const Kernel* kernel, CoordinatorApi& calls, LogTail log_tail, std::uint64_t seed);

  /// Renders the band and then sends its pixels. Bands are begun in the order of the calls, at most
  /// two at a time.
  void start(const Task& task) { executor_.add(task); }
  /// Cancels the rendering of a band whose lease was revoked, or drops its pixels.
  void stop(TaskId task);
  /// Called when the coordinator is reachable again.
  void connected() { uploader_.retry_now(); }

 private:
  /// Loads a scene for the executor, which calls this function as its LoadScene (scene_cache.h).
  absl::StatusOr<std::shared_ptr<const Scene>> load(const wire::Digest& manifest,
                                                    const std::atomic<bool>& stop,
                                                    const Prepared& prepared);
  ExecutorEvents executor_events();
  void failed(TaskId task, const absl::Status& status);
  /// Makes one attempt to send a band. The errors are those of SendBand (uploader.h).
  absl::StatusOr<farm::PutBandReply::Outcome> put(const FinishedBand& band);
  /// Removes a band from the session after the coordinator has acknowledged it or refused it for
  /// good. A refusal is reported as a failure of the band.
  void settled(TaskId task, const absl::StatusOr<farm::PutBandReply::Outcome>& outcome);

  SharedSession& session_;
  const std::unique_ptr<BlobCache> cache_;
  CoordinatorApi& calls_;
  const LogTail log_tail_;
  Pool pool_;
  PackageLoader loader_;  ///< called by the executor, for one scene at a time
  Uploader uploader_;
  Executor executor_;  ///< last: its threads use all of the above
};

}  // namespace bandsaw::worker
