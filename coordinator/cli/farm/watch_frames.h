#pragma once

// Follows a sequence (a job of many frames) to its end and fetches the images of its frames. The
// commands `submit --frames` and `watch` use it.

#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Files to write for the frames of a sequence, and what is made of the images.
struct WantedFrames {
  /// Names with a place for the number of a frame ("walk.####.png"); empty: no images are written.
  std::vector<std::string> outputs;
  ReportOption report;     ///< if it names a file, with a place for the number
  DisplayOptions display;  ///< for 8-bit files; unset values are taken from the scene
  AfterOptions after;
  Denoiser denoise = Denoiser::kNone;  ///< kNone: frames are not cleaned
};

/// How watch_frames() has ended.
struct WatchedFrames {
  ExitCode code = ExitCode::kDone;
  bool is_over = false;  ///< the job is done, failed or cancelled
};

/// Checks before any work is done that the files can be made. FAILED_PRECONDITION: ffmpeg is
/// missing. Other errors: a file cannot be written, or its name has no place for the number of a
/// frame.
absl::Status check_wanted(const WantedFrames& wanted);

/// Displays the progress of the sequence `job` until it is over. Writes the files of each frame
/// once the frame is done and, if wanted, its noise is removed. At the end makes the contact sheet
/// and the video, and runs the command of --then. After a signal it returns kInterrupted, and the
/// job continues on the farm. If the farm is unreachable, retries for one minute. kFailed: a frame
/// failed, or a file could not be written.
WatchedFrames watch_frames(FarmClient& client, JobId job, const WantedFrames& wanted,
                           Verbosity verbosity, Process& process);

}  // namespace bandsaw::coordinator
