#pragma once

// Shortens the journal, which grows with each decision. When it is long, the engine replaces it by
// the records that snapshot() returns (engine/scheduler_thread.cpp).

#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the smallest list of records whose replay gives the durable state, that is, the state
/// that survives a restart.
std::vector<Record> snapshot(const Context& context);

}  // namespace bandsaw::coordinator
