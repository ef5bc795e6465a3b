#pragma once

// Follows a job to its end and brings its image home.

#include <string>
#include <vector>

#include "coordinator/cli/commands.h"
#include "coordinator/cli/farm_client.h"

namespace bandsaw::coordinator {

/// Shows the job's progress until it is final, then fetches its image and writes `outputs`, if
/// there are any, 8-bit ones as `display_options` say, and the scene where they say nothing. A
/// signal detaches: the job goes on. A farm that goes away is waited for, a minute long.
ExitCode watch_job(FarmClient& client, JobId job, const std::vector<std::string>& outputs,
                   const DisplayOptions& display_options, Verbosity verbosity, Process& process);

}  // namespace bandsaw::coordinator
