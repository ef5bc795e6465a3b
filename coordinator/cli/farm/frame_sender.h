#pragma once

// Sends the scenes of the frames of a sequence (a job of many frames) to the farm, one after the
// other, on a thread of its own. `submit --frames` uses it.

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

/// Sends those parts of the package that the farm lacks, then gives the frame its scene. Waits up
/// to a minute for a farm that cannot be reached. CANCELLED: client.stop() was called. ABORTED: the
/// farm refused the scene, and the sequence is over (cancelled by a user, for example). Returns
/// other errors of the farm and of the package.
absl::Status send_frame(FarmClient& client, JobId sequence, FrameNumber frame,
                        ImportedPackage& package, ProgressDisplay& display);

/// Imports the scene at one frame. CANCELLED: `stop` was set.
using ImportFrame = std::function<absl::StatusOr<ImportedPackage>(FrameNumber frame,
                                                                  const std::atomic<bool>& stop)>;

class FrameSender {
 public:
  /// Starts at once, with a client of its own on the connection of `client`. If a frame cannot be
  /// sent, no further frame is sent. Then `failed` is called on the sender's thread, unless the
  /// frame was refused because the sequence is over.
  FrameSender(const FarmClient& client, const Console& console, JobId sequence,
              std::vector<FrameNumber> frames, ImportFrame import, std::function<void()> failed);
  /// Stops and waits for the thread.
  ~FrameSender();
  FrameSender(const FrameSender&) = delete;
  FrameSender& operator=(const FrameSender&) = delete;

  /// Waits until all frames are sent, or until one frame cannot be sent. Returns OK, or the error
  /// of that frame. CANCELLED: stop() was called. ABORTED: the sequence is over.
  absl::Status wait();
  /// Ends the import or the call that is in progress. Thread-safe.
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
  std::size_t sent_ GUARDED_BY(mutex_) = 0;  ///< number of frames that are sent
  absl::Status status_ GUARDED_BY(mutex_);   ///< error of the frame that could not be sent
  std::thread thread_;
};

}  // namespace bandsaw::coordinator
