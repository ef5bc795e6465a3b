#pragma once

#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

/// Returns the smallest list of records that replays to the durable state: a journal can be
/// replaced by it.
std::vector<Record> snapshot(const Context& context);

}  // namespace bandsaw::coordinator
