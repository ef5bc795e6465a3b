#pragma once

// Formats the state of a render as a JSON object, for --json. coordinator/README.md documents the
// events and their fields.

#include <string>
#include <vector>

#include "coordinator/cli/base/json.h"
#include "coordinator/cli/progress/progress.h"

namespace bandsaw::coordinator {

/// Returns an object with the fields that all events of a render have. `event`: the kind of event,
/// such as "job", "progress" or "done".
JsonObject progress_json(const Progress& progress, const std::string& event);

/// Adds the stop rule of a job as one field: stop_samples, stop_error or stop_time_s.
void add_stop(JsonObject& out, const StopRule& stop);

}  // namespace bandsaw::coordinator
