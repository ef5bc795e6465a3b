#pragma once

// A job's specification, and the plan of an adaptive job, as fields (record_text.h).

#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

void write_job(FieldWriter& out, const record::JobAdded& added);
record::JobAdded read_job(FieldReader& in);

void write_tiles(FieldWriter& out, const record::TilesPlanned& r);
/// Reports an error in `in` if a level is not a digit.
record::TilesPlanned read_tiles(FieldReader& in);

}  // namespace bandsaw::coordinator
