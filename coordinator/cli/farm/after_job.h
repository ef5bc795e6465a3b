#pragma once

// The option --then of `submit` and `watch` names a command that runs when a job is over.

#include <string>
#include <vector>

#include "coordinator/cli/farm/farm_client.h"
#include "coordinator/cli/options/commands.h"

namespace bandsaw::coordinator {

/// Runs the command of --then with sh. Does nothing if there is no such command, if `code` (the
/// result of watching the job `options.job`) is neither kDone nor kFailed, or if the farm does not
/// report that the job is over. The command's environment has BANDSAW_JOB, BANDSAW_STATE (done,
/// failed or cancelled), BANDSAW_FILES and BANDSAW_FILE_LIST. BANDSAW_FILES has `outputs`
/// unchanged, one a line: a name that stands for the files of all frames has #### in place of the
/// number. BANDSAW_FILE_LIST is the name of a file that lists all `files`, one a line. That file is
/// removed afterwards. The command writes to the standard output and standard error of this
/// process; with --json to standard error only. Returns `code`, or kFailed if the command does not
/// exit with 0. If this process gets a signal, such as SIGINT, run_after() kills the shell and
/// returns kInterrupted. Programs that the shell has started may continue.
ExitCode run_after(const WatchOptions& options, FarmClient& client,
                   const std::vector<std::string>& outputs, const std::vector<std::string>& files,
                   ExitCode code, Process& process);

}  // namespace bandsaw::coordinator
