#pragma once

// Results of audits as fields of journal records; each write function returns the record's kind.

#include <optional>

#include "absl/strings/string_view.h"
#include "coordinator/scheduler/api/records.h"
#include "coordinator/store/fields.h"

namespace bandsaw::coordinator {

const char* write_audit(FieldWriter& out, const record::BandAudited& r);
const char* write_audit(FieldWriter& out, const record::BandLost& r);
const char* write_audit(FieldWriter& out, const record::ErrorForgotten& r);
const char* write_audit(FieldWriter& out, const record::WorkerQuarantined& r);
const char* write_audit(FieldWriter& out, const record::QuarantineLifted& r);

/// Returns std::nullopt if the kind is none of these.
std::optional<Record> read_audit(absl::string_view kind, FieldReader& in);

}  // namespace bandsaw::coordinator
