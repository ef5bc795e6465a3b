#pragma once

// The records from which a job's report is made, as fields.

#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

/// The id of a worker process. Schema versions below 8 call the field "renderer".
void write_process(FieldWriter& out, WorkerProcessId process);
WorkerProcessId read_process(FieldReader& in);

void write_error(FieldWriter& out, const record::ErrorMeasured& r);
record::ErrorMeasured read_error(FieldReader& in);

void write_share(FieldWriter& out, const record::ShareCounted& r);
record::ShareCounted read_share(FieldReader& in);

}  // namespace bandsaw::coordinator
