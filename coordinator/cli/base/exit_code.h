#pragma once

// What the program's exit status says to scripts.

namespace bandsaw::coordinator {

enum class ExitCode : int {
  kDone = 0,
  kFailed = 1,        ///< the work was begun and did not end well
  kWrong = 2,         ///< wrong usage or input: the same call fails again
  kNoFarm = 3,        ///< no farm was reached, or it was lost: the same call may succeed later
  kInterrupted = 130  ///< SIGINT or SIGTERM, as shells count it
};

}  // namespace bandsaw::coordinator
