#pragma once

// The rendering half of a worker: cache, pool, executor and uploader, reporting to the desk.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "renderlib/base/pool.h"
#include "worker/cache/blob_cache.h"
#include "worker/executor/executor.h"
#include "worker/executor/load_package.h"
#include "worker/executor/uploader.h"
#include "worker/session/desk.h"

namespace bandsaw::worker {

/// What it needs of the farm: the calls of the bulk channel, or a test's own.
struct FarmDoors {
  TransferBlob get_blob;
  std::function<absl::StatusOr<farm::PutBandReply::Outcome>(const FinishedBand&, const LeaseName&)>
      put_band;
};

/// The last lines of this process's log, for a failure's report.
using LogTail = std::function<std::vector<std::string>()>;

class Workshop {
 public:
  /// `kernel`: what renders the scenes; as in Scene::build.
  Workshop(Desk& desk, std::unique_ptr<BlobCache> cache, int threads, const Kernel* kernel,
           FarmDoors farm, LogTail log_tail, std::uint64_t seed);

  void start(const Task& task) { executor_.add(task); }
  void stop(TaskId task);
  /// The coordinator is there again.
  void connected() { uploader_.retry_now(); }

 private:
  absl::StatusOr<std::shared_ptr<const Scene>> load(const wire::Digest& manifest,
                                                    const std::atomic<bool>& stop,
                                                    const Prepared& prepared);
  ExecutorEvents executor_events();
  void failed(TaskId task, const absl::Status& status);
  absl::StatusOr<farm::PutBandReply::Outcome> put(const FinishedBand& band);
  void settled(TaskId task, const absl::StatusOr<farm::PutBandReply::Outcome>& outcome);

  Desk& desk_;
  const std::unique_ptr<BlobCache> cache_;
  const FarmDoors farm_;
  const LogTail log_tail_;
  const Kernel* const kernel_;
  Pool pool_;
  Uploader uploader_;
  Executor executor_;  ///< last: its threads use all of the above
};

}  // namespace bandsaw::worker
