#pragma once

// Workers that are not let in.

#include <string>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// A worker that was refused, as it is shown.
struct Refusal {
  std::string instance;
  WorkerView worker;
  Time at = 0;  ///< wall clock
};

/// A worker process that returned wrong pixels, or that a person sent away.
struct Quarantined {
  std::string name;  ///< of the machine, as it says it
  std::string reason;
  bool lifted = false;
};

}  // namespace bandsaw::coordinator
