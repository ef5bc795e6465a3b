#pragma once

// Progress as JSON. The events are documented in coordinator/README.md.

#include <string>
#include <vector>

#include "coordinator/cli/base/json.h"
#include "coordinator/cli/progress/progress.h"

namespace bandsaw::coordinator {

/// Returns the fields common to all events of a render. `event`: "job", "progress", "done", …
JsonObject progress_json(const Progress& progress, const std::string& event);

/// Adds one of stop_samples, stop_error and stop_time_s.
void add_stop(JsonObject& out, const StopRule& stop);

}  // namespace bandsaw::coordinator
