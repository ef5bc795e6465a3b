#pragma once

// The engine's doors to the world that tests replace: where the records go, and what time it is.

#include <memory>

#include "coordinator/engine/clock.h"
#include "coordinator/store/journal.h"

namespace bandsaw::coordinator {

/// A door that is null is the real one: SQLite in the data folder, the steady clock.
struct EngineDependencies {
  std::unique_ptr<Journal> journal;
  std::unique_ptr<Clock> clock;
};

}  // namespace bandsaw::coordinator
