#pragma once

// Follows a job to its end and brings its image home.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"
#include "coordinator/cli/progress/progress_display.h"
#include "renderlib/image/layers.h"

namespace bandsaw::coordinator {

/// Where a job's image goes, and how.
struct Wanted {
  std::vector<std::string> outputs;  ///< may be empty: the image is not fetched
  std::vector<std::string> reports;  ///< checked by report_files
  DisplayOptions display;            ///< of 8-bit files; what it does not say the scene does
  std::string tev;                   ///< HOST:PORT of a viewer; empty: none
};

/// Shows the job's progress until it is final: its last state. A farm that goes away is waited for,
/// a minute long: UNAVAILABLE. CANCELLED: `client` was stopped.
absl::StatusOr<Progress> follow_job(FarmClient& client, JobId job, ProgressDisplay& display);

/// What stands beside an image that has so many samples a pixel.
using BesideImage =
    std::function<absl::StatusOr<Layers>(std::uint64_t samples, ProgressDisplay& display)>;

/// Shows the job's progress until it is final, then fetches its image and writes what is wanted,
/// with what `beside` makes of it, if given. A signal detaches: the job goes on. A farm that goes
/// away is waited for, a minute long.
ExitCode watch_job(FarmClient& client, JobId job, const Wanted& wanted, Verbosity verbosity,
                   Process& process, const BesideImage& beside = {});

}  // namespace bandsaw::coordinator
