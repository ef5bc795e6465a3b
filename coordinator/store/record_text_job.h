#pragma once

// The specification of a job or sequence, the plan of an adaptive job, and the scene of a frame, as
// fields (record_text.h).

#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

void write_job(FieldWriter& out, const record::JobAdded& added);
record::JobAdded read_job(FieldReader& in);

void write_tiles(FieldWriter& out, const record::TilesPlanned& r);
/// Reports an error in `in` if a level is not a digit.
record::TilesPlanned read_tiles(FieldReader& in);

void write_sequence(FieldWriter& out, const record::SequenceAdded& added);
/// Reports an error in `in` if the frames are not what parse_frames reads.
record::SequenceAdded read_sequence(FieldReader& in);

void write_frame(FieldWriter& out, const record::FrameWaits& r);
record::FrameWaits read_frame(FieldReader& in);

}  // namespace bandsaw::coordinator
