#pragma once

// Follows a sequence (a job of many frames) to its end and fetches the images of its frames. The
// commands `submit --frames` and `watch` use it.

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// How watch_frames() has ended.
struct WatchedFrames {
  ExitCode code = ExitCode::kDone;
  bool is_over = false;  ///< the job is done, failed or cancelled
};

/// Checks that the files for the frames of a sequence can be made. Commands call it before any work
/// is done. FAILED_PRECONDITION: ffmpeg is missing. Other errors: a file cannot be written, or its
/// name has no place for the number of a frame.
absl::Status check_frame_files(const WatchOptions& options);

/// Displays the progress of the sequence `options.job` until it is over. Writes the files of each
/// frame once the frame is done and, if wanted, its noise is removed. At the end makes the contact
/// sheet and the video, and runs the command of --then. After a signal it returns kInterrupted, and
/// the job continues on the farm. If the farm is unreachable, retries for one minute. kFailed: a
/// frame failed, or a file could not be written.
WatchedFrames watch_frames(FarmClient& client, const WatchOptions& options, Process& process);

}  // namespace bandsaw::coordinator
