#pragma once

// Starts a child process. run_child(), Coprocess and PipedChild of this folder use it.

#include <sys/types.h>

#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// The standard streams of a child. spawn() does not close the caller's file descriptors. -1: there
/// is no file descriptor.
struct SpawnStreams {
  int input = -1;                        ///< if there is none, `input_file` is opened
  std::string input_file = "/dev/null";  ///< a path
  int output = -1;                       ///< if there is none, the output is discarded
  int errors = -1;                       ///< if there is none, standard error is discarded
};

/// Starts `arguments[0]` (a path, or a name on PATH) with posix_spawn, without a shell, and returns
/// its process id. The child has no blocked signals and the default dispositions of SIGINT, SIGTERM
/// and SIGPIPE, whatever this process does with them, so Ctrl-C in a terminal ends the child
/// at once. Returns the system's error if the program could not be started.
absl::StatusOr<pid_t> spawn(const std::vector<std::string>& arguments, const SpawnStreams& streams);

}  // namespace bandsaw::coordinator
