#pragma once

// Lines of the coordinator's own log about jobs and workers, as key=value pairs.

#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Logs a change of a job or a worker.
void log_record(const Record& record);
/// Logs a backup task as "copied job=7 rows=0:12 samples=0:16 from=desk to=laptop". For stolen rows
/// the line begins with "moved". Tests count these lines.
void log_reassignment(const action::LogReassignment& reassignment);
/// Logs that a worker could not render a band.
void log_failure(const action::LogFailure& failure);

}  // namespace bandsaw::coordinator
