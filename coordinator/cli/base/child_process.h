#pragma once

// Runs one child process to its end, with a time limit. The importer, Blender, ssh and the command
// that the user gives with --then are run this way.

#include <atomic>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

/// How a child process ended, and what it wrote.
struct ChildOutcome {
  enum class End {
    kExited,    ///< ended by itself; see wait_status
    kTimedOut,  ///< killed because the time limit expired
    kStopped,   ///< killed because the caller set `stop`
  };
  End end = End::kExited;
  int wait_status = 0;  ///< as returned by waitpid; read it with WIFEXITED and the like
  /// Standard output of the child (with standard error, if the caller asked for it), at most 64
  /// KiB; empty if the child wrote to a file descriptor of the caller.
  std::string output;
};

/// Where the standard streams of a child lead.
struct ChildStreams {
  std::string input = "/dev/null";  ///< file from which standard input is read
  bool errors_too = false;          ///< include standard error in the output
  /// File descriptor that the child gets as its standard output. The child's standard error is then
  /// that of this process, and ChildOutcome::output stays empty. -1: the output is collected.
  int output = -1;
};

/// Starts `arguments[0]` (a path, or a name on PATH) with posix_spawn, without a shell, and waits
/// until it has ended. Kills it after `seconds`, or when another thread sets `stop`. `stop` may be
/// nullptr; it is polled every 20 ms. The child has the default dispositions of SIGINT and SIGTERM,
/// whatever this process does with them, so Ctrl-C in a terminal ends the child. Returns the
/// system's error if the child could not be started. If the child itself fails, run_child() returns
/// no error; ChildOutcome::wait_status has the child's exit status.
absl::StatusOr<ChildOutcome> run_child(const std::vector<std::string>& arguments, double seconds,
                                       const std::atomic<bool>* stop,
                                       const ChildStreams& streams = {});

}  // namespace bandsaw::coordinator
