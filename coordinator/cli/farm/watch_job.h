#pragma once

// Follows a job to its end, fetches its image and writes its files, for `submit` and `watch`.

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/progress/progress_display.h"
#include "renderlib/denoise/denoise.h"
#include "renderlib/image/layers.h"

namespace bandsaw::coordinator {

/// Files to write for a job, and their settings.
struct Wanted {
  std::vector<std::string> outputs;    ///< empty: no image is written
  std::vector<std::string> reports;    ///< names that report_files() has returned
  DisplayOptions display;              ///< for 8-bit files; unset values are taken from the scene
  std::string tev;                     ///< HOST:PORT of a tev viewer; empty: none
  Denoiser denoise = Denoiser::kNone;  ///< kNone: the noise is not removed
};

/// The images and figures of a finished job, which are written to files.
struct JobPictures {
  Progress job;  ///< last status of the job
  FarmImage result;
  Layers layers;                  ///< additional layers of EXR files
  std::optional<Denoised> clean;  ///< the image without noise; std::nullopt: not wanted

  /// Returns the clean image if there is one, otherwise the image as rendered.
  const Image& best() const { return clean ? clean->image : result.image; }
};

/// Returns a sentence with the command, ready for a shell, that follows the job again and writes
/// the same files: "Come back with: bandsaw watch 7 --denoise -o walk.png". `otherwise`: the file
/// name in the command if there are no outputs. The command has --farm if the user's --farm was the
/// name of a file. A join string is not shown, because it has a secret.
std::string come_back(const WatchOptions& options, const std::string& otherwise);

/// Prints why a command ends before it has written the files of a job, and returns the exit code.
/// `how`: the sentence of come_back(), which is printed if the user interrupted the command or the
/// farm cannot be reached. `otherwise`: the whole text for any other error.
ExitCode left_early(const absl::Status& status, JobId job, const std::string& how,
                    const std::string& otherwise, const Console& console);

/// Writes the images and the reports. Returns the first error.
absl::Status write_pictures(const JobPictures& pictures, const Wanted& wanted);

/// Displays the job's progress until its state is final (done, failed or cancelled), and returns
/// the last status. If the farm is unreachable, retries for one minute. UNAVAILABLE: the farm did
/// not come back. CANCELLED: client.stop() was called. `on_status` is called with each status, also
/// with the last one.
absl::StatusOr<Progress> follow_job(FarmClient& client, JobId job, ProgressDisplay& display,
                                    const std::function<void(const Progress&)>& on_status = {});

/// A function that makes the additional layers for an image of `samples` samples per pixel.
using BesideImage =
    std::function<absl::StatusOr<Layers>(std::uint64_t samples, ProgressDisplay& display)>;

/// Displays the job's progress until its state is final. Then fetches its image, and writes the
/// files and `reports` (names that report_files() has returned). If `beside` is not empty, the
/// files get the layers that it makes. After a signal watch_job() returns kInterrupted, and the job
/// continues on the farm. If the farm is unreachable, retries for one minute.
ExitCode watch_job(FarmClient& client, const WatchOptions& options,
                   const std::vector<std::string>& reports, Process& process,
                   const BesideImage& beside = {});

}  // namespace bandsaw::coordinator
