#pragma once

// Sends the scenes of a sequence's frames to the farm, one after the other, on a thread of its own.

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "coordinator/cli/base/console.h"
#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/progress/progress_display.h"
#include "coordinator/cli/scene/import_process.h"
#include "renderlib/base/mutex.h"

namespace bandsaw::coordinator {

/// Sends the blobs that the farm lacks, then gives the frame its scene. Waits up to a minute for a
/// farm that cannot be reached. Returns errors of the farm and of the package.
absl::Status send_frame(FarmClient& client, JobId sequence, FrameNumber frame,
                        ImportedPackage& package, ProgressDisplay& display);

/// Imports the scene at one frame.
using ImportFrame = std::function<absl::StatusOr<ImportedPackage>(FrameNumber frame,
                                                                  const std::atomic<bool>& stop)>;

class FrameSender {
 public:
  /// Starts at once. `failed` is called on the thread if a frame cannot be sent; no other is sent
  /// then.
  FrameSender(const FarmClient& client, const Console& console, JobId sequence,
              std::vector<FrameNumber> frames, ImportFrame import, std::function<void()> failed);
  /// Stops after the present step.
  ~FrameSender();
  FrameSender(const FrameSender&) = delete;
  FrameSender& operator=(const FrameSender&) = delete;

  /// Waits until all frames are sent, or one of them cannot be. CANCELLED: stopped.
  absl::Status wait();
  void stop();
  /// Returns the frames that are not sent.
  std::vector<FrameNumber> unsent() const EXCLUDES(mutex_);

 private:
  void run() EXCLUDES(mutex_);
  absl::Status send(FrameNumber frame);

  const std::unique_ptr<FarmClient> client_;
  const JobId sequence_;
  const std::vector<FrameNumber> frames_;
  const ImportFrame import_;
  const std::function<void()> failed_;
  ProgressDisplay display_;  ///< prints nothing
  std::atomic<bool> stop_{false};
  mutable Mutex mutex_;
  std::size_t sent_ GUARDED_BY(mutex_) = 0;
  absl::Status status_ GUARDED_BY(mutex_);
  std::thread thread_;
};

}  // namespace bandsaw::coordinator
