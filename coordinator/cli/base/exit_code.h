#pragma once

// Exit status of the program, for scripts.

namespace bandsaw::coordinator {

enum class ExitCode : int {
  kDone = 0,
  kFailed = 1,  ///< the work was started and did not succeed
  kWrong = 2,   ///< wrong usage or input: the same call will fail again
  /// No farm was reached, or the connection was lost: the same call may succeed later.
  kNoFarm = 3,
  kInterrupted = 130  ///< SIGINT or SIGTERM, as reported by shells
};

}  // namespace bandsaw::coordinator
