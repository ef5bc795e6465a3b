#pragma once

// Shortens the journal. It grows with each decision, so the engine replaces a long journal by this
// list of records (engine/scheduler_thread.cpp).

#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the smallest list of records that replays to the durable state.
std::vector<Record> snapshot(const Context& context);

}  // namespace bandsaw::coordinator
