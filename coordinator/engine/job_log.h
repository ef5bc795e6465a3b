#pragma once

#include "coordinator/scheduler/api/messages.h"

namespace bandsaw::coordinator {

/// Logs a change of a job or a worker.
void log_record(const Record& record);
/// "copied job=7 rows=0:12 samples=0:16 from=desk to=laptop"; tests count these.
void log_shared(const action::LogReassignment& shared);
void log_fault(const action::LogFailure& fault);

}  // namespace bandsaw::coordinator
