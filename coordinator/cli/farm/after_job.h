#pragma once

// The option --then of `submit` and `watch` names a command that runs when a job is over.

#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Runs `command` with sh. Does nothing if `command` is empty, if `code` (the result of watching
/// the job) is neither kDone nor kFailed, or if the job is not over. The command's environment has
/// BANDSAW_JOB, BANDSAW_STATE (done, failed or cancelled), BANDSAW_FILES (`outputs`, one a line, as
/// given: with #### for the number of a frame) and BANDSAW_FILE_LIST, the name of a file that lists
/// all `files`, one a line, and is removed afterwards. The command's output, at most 64 KiB, is
/// printed when it has ended. Returns `code`, or kFailed if the command does not exit with 0.
ExitCode run_after(const std::string& command, FarmClient& client, JobId job,
                   const std::vector<std::string>& outputs, const std::vector<std::string>& files,
                   ExitCode code, const Console& console);

}  // namespace bandsaw::coordinator
