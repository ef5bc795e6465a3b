#pragma once

// The plan of an adaptive job as text (record_text.h).

#include "coordinator/core/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

/// Its kind.
const char* write_tiles(FieldWriter& out, const record::TilesPlanned& r);
/// Refuses, in `in`, levels that are no digits.
Record read_tiles(FieldReader& in);

}  // namespace bandsaw::coordinator
