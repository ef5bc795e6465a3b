#pragma once

// Follows a sequence to its end and fetches the images of its frames.

#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Files to write for the frames of a sequence, and what is made of them.
struct WantedFrames {
  std::vector<std::string> outputs;  ///< with a place for the number of a frame; may be empty
  ReportOption report;               ///< file: with a place for the number
  DisplayOptions display;            ///< for 8-bit files; unset values are taken from the scene
  AfterOptions after;
  Denoiser denoise = Denoiser::kNone;  ///< kNone: frames are not cleaned
};

/// Checks the files before any work is done: FAILED_PRECONDITION: ffmpeg is missing. Other errors:
/// a file cannot be written, or its name has no place for the number of a frame.
absl::Status check_wanted(const WantedFrames& wanted);

/// Displays the progress of a sequence until it is over, and writes the files of each frame once it
/// is done and, if wanted, cleaned; then the contact sheet and the video, and runs the command. A
/// signal detaches from the job, which continues. If the farm is unreachable, retries for one
/// minute. kFailed: a frame failed, or a file could not be written.
ExitCode watch_frames(FarmClient& client, JobId job, const WantedFrames& wanted,
                      Verbosity verbosity, Process& process);

}  // namespace bandsaw::coordinator
