#pragma once

// Lines of the coordinator's own log about jobs and workers, as key=value pairs.

#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Logs a change of a job or a worker.
void log_record(const Record& record);
/// Logs that an idle worker was given rows of another worker: "copied job=7 rows=0:12 samples=0:16
/// from=desk to=laptop". "copied": the other worker has begun the rows, and both workers render
/// them (a backup task). The line begins with "moved" if the rows were taken from the other worker
/// before it had begun them. Tests count these lines.
void log_reassignment(const action::LogReassignment& reassignment);
/// Logs that a worker could not render a band.
void log_failure(const action::LogFailure& failure);

}  // namespace bandsaw::coordinator
