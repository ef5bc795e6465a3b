#pragma once

// What a job is, and the plan of an adaptive one, as fields (record_text.h).

#include "coordinator/core/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

void write_job(FieldWriter& out, const record::JobAdded& added);
record::JobAdded read_job(FieldReader& in);

void write_tiles(FieldWriter& out, const record::TilesPlanned& r);
/// Refuses, in `in`, levels that are no digits.
record::TilesPlanned read_tiles(FieldReader& in);

}  // namespace bandsaw::coordinator
