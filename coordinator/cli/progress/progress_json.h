#pragma once

// Progress for programs. The events are documented in coordinator/README.md.

#include <string>
#include <vector>

#include "coordinator/cli/base/json.h"
#include "coordinator/cli/progress/progress.h"

namespace bandsaw::coordinator {

/// What every event about a render holds. `event`: "job", "progress", "done", …
JsonObject progress_json(const Progress& progress, const std::string& event);

/// One of stop_samples, stop_error and stop_time_s.
void add_stop(JsonObject& out, const StopRule& stop);

}  // namespace bandsaw::coordinator
