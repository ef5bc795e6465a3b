#pragma once

// One child process, run to its end under a time limit.

#include <atomic>
#include <string>
#include <vector>

#include "absl/status/statusor.h"

namespace bandsaw::coordinator {

struct ChildOutcome {
  enum class End {
    kExited,    ///< by itself: see wait_status
    kTimedOut,  ///< killed: the time passed
    kStopped,   ///< killed: `stop` was set
  };
  End end = End::kExited;
  int wait_status = 0;  ///< as waitpid gives it
  std::string output;   ///< what it wrote to its standard output, at most 64 KiB
};

struct ChildStreams {
  std::string input = "/dev/null";  ///< path of what it reads from standard input
  bool errors_too = false;          ///< what it writes to standard error is output too
};

/// Starts `arguments[0]` (a path, or a name on PATH) by posix_spawn, without a shell, and waits
/// until it ends; when this returns it is gone. It gets the default dispositions of SIGINT and
/// SIGTERM whatever this process does with them, so Ctrl-C in a terminal ends it. `stop` may be
/// null; it is looked at every 20 ms. The error is the system's: it could not be started.
absl::StatusOr<ChildOutcome> run_child(const std::vector<std::string>& arguments, double seconds,
                                       const std::atomic<bool>* stop,
                                       const ChildStreams& streams = {});

}  // namespace bandsaw::coordinator
