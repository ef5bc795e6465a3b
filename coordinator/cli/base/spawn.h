#pragma once

// Starts a child process.

#include <spawn.h>
#include <sys/types.h>

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// Starts `arguments[0]` (a path, or a name on PATH) with posix_spawn, without a shell, and returns
/// its process id. The child has no blocked signals and the default dispositions of SIGINT, SIGTERM
/// and SIGPIPE, whatever this process does with them, so Ctrl-C in a terminal ends it at once.
/// Returns the system's error if it could not be started.
absl::StatusOr<pid_t> spawn(const std::vector<std::string>& arguments,
                            const posix_spawn_file_actions_t& actions);

}  // namespace bandsaw::coordinator
