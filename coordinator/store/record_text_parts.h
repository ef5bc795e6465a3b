#pragma once

// Functions that write and read groups of journal records as text fields. They are parts of
// record_text.cpp, which converts all records. Each function read_X reads the output of write_X.
// The FieldReader keeps the first error.

#include <optional>

#include "absl/strings/string_view.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

// The specification of a job or sequence, the plan of an adaptive job, and the scene of a frame
// (record_text_job.cpp).
void write_job(FieldWriter& out, const record::JobAdded& added);
record::JobAdded read_job(FieldReader& in);

/// Writes the plan of an adaptive job: the number of samples that each pixel gets before the plan,
/// and one digit for each half tile (half of the pixels of a tile). The digit is the level of the
/// half tile, which determines how many samples its pixels get.
void write_tiles(FieldWriter& out, const record::TilesPlanned& r);
/// Reports an error in `in` if a level is not a hexadecimal digit in lower case.
record::TilesPlanned read_tiles(FieldReader& in);

void write_sequence(FieldWriter& out, const record::SequenceAdded& added);
/// Reports an error in `in` if the frames are not what parse_frames reads.
record::SequenceAdded read_sequence(FieldReader& in);

void write_frame(FieldWriter& out, const record::FrameWaits& r);
record::FrameWaits read_frame(FieldReader& in);

// Records from which a job's report is made (record_text_report.cpp).
/// Writes the id of a worker process. Schema versions below 8 call the field "renderer".
void write_process(FieldWriter& out, WorkerProcessId process);
WorkerProcessId read_process(FieldReader& in);

void write_error(FieldWriter& out, const record::ErrorMeasured& r);
record::ErrorMeasured read_error(FieldReader& in);

void write_share(FieldWriter& out, const record::ShareCounted& r);
record::ShareCounted read_share(FieldReader& in);

// Results of audits (record_text_audit.cpp). Each write function returns the record's kind.
const char* write_audit(FieldWriter& out, const record::BandAudited& r);
const char* write_audit(FieldWriter& out, const record::BandLost& r);
const char* write_audit(FieldWriter& out, const record::RowDisputed& r);
const char* write_audit(FieldWriter& out, const record::ErrorForgotten& r);
const char* write_audit(FieldWriter& out, const record::WorkerQuarantined& r);
const char* write_audit(FieldWriter& out, const record::QuarantineLifted& r);
/// Reads the output of write_audit(); std::nullopt if `kind` is the kind of another record.
std::optional<Record> read_audit(absl::string_view kind, FieldReader& in);

}  // namespace bandsaw::coordinator
