#pragma once

// Follows a job to its end and fetches its image.

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
  std::vector<std::string> outputs;  ///< may be empty: the image is not fetched
  std::vector<std::string> reports;  ///< already checked by report_files
  DisplayOptions display;            ///< for 8-bit files; unset values are taken from the scene
  std::string tev;                   ///< HOST:PORT of a tev viewer; empty: none
  Denoiser denoise = Denoiser::kNone;
};

/// All pictures of a finished job that are written.
struct JobPictures {
  Progress job;  ///< last status of the job
  FarmImage result;
  Layers layers;
  std::optional<Denoised> clean;  ///< absent if the image is not cleaned

  /// The clean image, or else the one as rendered.
  const Image& best() const { return clean ? clean->image : result.image; }
};

/// Returns a sentence with the command that follows the job again and writes the same files, or
/// `otherwise` if there are none: "Come back with: bandsaw watch 7 --denoise -o walk.png".
std::string come_back(JobId job, const std::vector<std::string>& outputs, Denoiser denoise,
                      const std::string& otherwise);

/// Prints why a command ends before it has written the files of a job, and returns the exit code.
/// `how`: of come_back(); `otherwise`: the text for an error that is neither an interruption nor a
/// farm that is not reached.
ExitCode left_early(const absl::Status& status, JobId job, const std::string& how,
                    const std::string& otherwise, const Console& console);

/// Writes the files of a job.
absl::Status write_pictures(const JobPictures& pictures, const Wanted& wanted);

/// Displays the job's progress until its state is final, and returns the last status. If the farm
/// is unreachable, retries for one minute. UNAVAILABLE: it did not come back. CANCELLED: `client`
/// was stopped. `on_status` is called with each state, also the last one.
absl::StatusOr<Progress> follow_job(FarmClient& client, JobId job, ProgressDisplay& display,
                                    const std::function<void(const Progress&)>& on_status = {});

/// Returns additional layers to be written with an image of that many samples per pixel.
using BesideImage =
    std::function<absl::StatusOr<Layers>(std::uint64_t samples, ProgressDisplay& display)>;

/// Displays the job's progress until its state is final, then fetches its image and writes the
/// files, with the layers made by `beside`, if given. A signal detaches from the job, which
/// continues. If the farm is unreachable, retries for one minute.
ExitCode watch_job(FarmClient& client, JobId job, const Wanted& wanted, Verbosity verbosity,
                   Process& process, const BesideImage& beside = {});

}  // namespace bandsaw::coordinator
