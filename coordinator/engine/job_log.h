#pragma once

#include "coordinator/core/messages.h"

namespace bandsaw::coordinator {

/// Logs a change of a job or a worker.
void log_record(const Record& record);
/// "copied job=7 rows=0:12 samples=0:16 from=desk to=laptop"; tests count these.
void log_shared(const action::Shared& shared);
void log_fault(const action::Faulted& fault);

}  // namespace bandsaw::coordinator
