// Text of records about audits, damaged bands and quarantine: for each kind a function that writes
// the fields, and one that reads them in the same order. In an audit, a second machine renders a
// stored band again, and the results are compared.

#include "coordinator/store/record_text_parts.h"

#include <cstdint>

namespace bandsaw::coordinator {

namespace {

/// Writes the fields of a stored band and of the worker process that rendered it.
void write_stored(FieldWriter& out, JobId job, const Band& band, WorkerProcessId process) {
  out.number("job", job);
  out.number("first", band.samples.first);
  out.number("last", band.samples.last);
  out.number("first_row", band.rows.first);
  out.number("last_row", band.rows.last);
  write_process(out, process);
}

// Braced initialisers are evaluated in the order in which they are written, which is the order of
// the fields.

/// Reads the output of write_stored(). The records BandAudited and BandLost have no other fields.
template <class R>
R read_stored(FieldReader& in) {
  return {.job = in.number("job"),
          .band = {.samples = {.first = in.number("first"), .last = in.number("last")},
                   .rows = {.first = static_cast<std::uint32_t>(in.number("first_row", UINT32_MAX)),
                            .last = static_cast<std::uint32_t>(in.number("last_row", UINT32_MAX))}},
          .process = read_process(in)};
}

record::RowDisputed read_disputed(FieldReader& in) {
  const auto stored = read_stored<record::BandAudited>(in);
  return {.job = stored.job,
          .band = stored.band,
          .stored = {.process = stored.process,
                     .machine = in.text("machine"),
                     .digest = in.number("digest")},
          .other = {.process = in.number("other"),
                    .machine = in.text("other_machine"),
                    .digest = in.number("other_digest")}};
}

}  // namespace

const char* write_audit(FieldWriter& out, const record::BandAudited& r) {
  write_stored(out, r.job, r.band, r.process);
  return "band_audited";
}

const char* write_audit(FieldWriter& out, const record::BandLost& r) {
  write_stored(out, r.job, r.band, r.process);
  return "band_lost";
}

const char* write_audit(FieldWriter& out, const record::RowDisputed& r) {
  write_stored(out, r.job, r.band, r.stored.process);
  out.text("machine", r.stored.machine);
  out.number("digest", r.stored.digest);
  out.number("other", r.other.process);
  out.text("other_machine", r.other.machine);
  out.number("other_digest", r.other.digest);
  return "row_disputed";
}

const char* write_audit(FieldWriter& out, const record::ErrorForgotten& r) {
  out.number("job", r.job);
  return "error_forgotten";
}

const char* write_audit(FieldWriter& out, const record::WorkerQuarantined& r) {
  out.number("browser", r.browser ? 1 : 0);
  write_process(out, r.process);
  out.text("name", r.name);
  out.text("reason", r.reason);
  return "worker_quarantined";
}

const char* write_audit(FieldWriter& out, const record::QuarantineLifted& r) {
  out.text("name", r.name);
  return "quarantine_lifted";
}

std::optional<Record> read_audit(absl::string_view kind, FieldReader& in) {
  if (kind == "band_audited") {
    return read_stored<record::BandAudited>(in);
  }
  if (kind == "band_lost") {
    return read_stored<record::BandLost>(in);
  }
  if (kind == "row_disputed") {
    return read_disputed(in);
  }
  if (kind == "error_forgotten") {
    return record::ErrorForgotten{.job = in.number("job")};
  }
  if (kind == "worker_quarantined") {
    record::WorkerQuarantined quarantined;  // schema versions below 11 lack the field `browser`
    quarantined.browser = in.next_is("browser") && in.number("browser", 1) == 1;
    quarantined.process = read_process(in);
    quarantined.name = in.text("name");
    quarantined.reason = in.text("reason");
    return quarantined;
  }
  if (kind == "quarantine_lifted") {
    return record::QuarantineLifted{.name = in.text("name")};
  }
  return std::nullopt;
}

}  // namespace bandsaw::coordinator
