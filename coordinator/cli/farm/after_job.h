#pragma once

// --then: a command of the user that runs when a job is over.

#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Runs the command with sh, if it is not empty and the job is over. Its environment has
/// BANDSAW_JOB, BANDSAW_STATE (done, failed or cancelled), BANDSAW_FILES (`outputs`, one a line, as
/// given: with #### for the number of a frame) and BANDSAW_FILE_LIST, the name of a file that lists
/// all `files`, one a line, and is removed afterwards. Its output is printed. Returns `code`, or
/// kFailed if the command does not exit with 0.
ExitCode run_after(const std::string& command, FarmClient& client, JobId job,
                   const std::vector<std::string>& outputs, const std::vector<std::string>& files,
                   ExitCode code, const Console& console);

}  // namespace bandsaw::coordinator
