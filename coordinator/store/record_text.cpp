// to_text() writes the fields of each kind of record, and from_text() reads them in the same order.
// This order is a part of the format. The functions for long groups of fields are declared in
// record_text_parts.h.

#include "coordinator/store/record_text.h"

#include <array>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_join.h"
#include "absl/strings/str_split.h"
#include "absl/strings/string_view.h"
#include "coordinator/store/fields.h"
#include "coordinator/store/record_text_parts.h"
#include "renderlib/base/overloaded.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

struct StateName {
  JobState state;
  absl::string_view name;
};
constexpr std::array<StateName, 6> kStates = {{{JobState::kRunning, "running"},
                                               {JobState::kPaused, "paused"},
                                               {JobState::kFinishing, "finishing"},
                                               {JobState::kDone, "done"},
                                               {JobState::kFailed, "failed"},
                                               {JobState::kCancelled, "cancelled"}}};

absl::string_view name_of(JobState state) {
  for (const StateName& s : kStates) {
    if (s.state == state) {
      return s.name;
    }
  }
  return "";
}

/// Reads a field with the name of a state. If the name is unknown, sets the error of `in`.
JobState state_field(FieldReader& in, absl::string_view name) {
  const std::string found = in.text(name);
  for (const StateName& s : kStates) {
    if (s.name == found) {
      return s.state;
    }
  }
  in.refuse(absl::StrCat("field '", name, "': unknown state '", found, "'"));
  return JobState::kFailed;
}

void write_summary(FieldWriter& out, const record::JobSummary& r) {
  out.number("job", r.job);
  out.real("elapsed_s", r.elapsed_s);
  out.real("cpu_s", r.cpu_s);
  out.number("workers_used", r.workers_used);
  out.number("samples", r.samples);
  out.number("samples_per_pixel", r.samples_per_pixel);
  out.real("error", r.error);
  out.number("negative_samples", r.counters.negative_samples);
  out.number("truncated_paths", r.counters.truncated_paths);
  out.number("dropped_primitives", r.counters.dropped_primitives);
  out.number("techniques", r.counters.techniques);
  out.number("training_rays", r.counters.training_rays);
  out.number("rays", r.counters.rays);
  out.number("bad_samples", r.counters.bad_samples);
  out.number("bad_x", r.counters.bad_x);
  out.number("bad_y", r.counters.bad_y);
  out.number("bad_sample", r.counters.bad_sample);
}

/// Reads the counters of a summary. Records of older versions lack the first five.
Counters read_counters(FieldReader& in) {
  Counters counters;
  if (in.next_is("negative_samples")) {
    counters.negative_samples = in.number("negative_samples");
    counters.truncated_paths = in.number("truncated_paths");
    counters.dropped_primitives = in.number("dropped_primitives");
  }
  if (in.next_is("techniques")) {
    counters.techniques = static_cast<std::uint32_t>(in.number("techniques", UINT32_MAX));
    counters.training_rays = in.number("training_rays");
  }
  counters.rays = in.number("rays");
  counters.bad_samples = in.number("bad_samples");
  counters.bad_x = static_cast<std::uint32_t>(in.number("bad_x", UINT32_MAX));
  counters.bad_y = static_cast<std::uint32_t>(in.number("bad_y", UINT32_MAX));
  counters.bad_sample = in.number("bad_sample");
  return counters;
}

Record read_summary(FieldReader& in) {
  return record::JobSummary{
      .job = in.number("job"),
      .elapsed_s = in.real("elapsed_s"),
      .cpu_s = in.real("cpu_s"),
      .workers_used = static_cast<std::uint32_t>(in.number("workers_used", UINT32_MAX)),
      .samples = in.number("samples"),
      .samples_per_pixel = in.number("samples_per_pixel"),
      .error = in.real("error"),
      .counters = read_counters(in)};
}

/// Reads the fields of a record of this kind. If the kind is unknown, sets the error of `in`.
Record read_record(absl::string_view kind, FieldReader& in) {
  if (kind == "job_added") {
    return read_job(in);
  }
  if (kind == "pass_planned") {
    return record::PassPlanned{.job = in.number("job"),
                               .samples = {.first = in.number("first"), .last = in.number("last")}};
  }
  if (kind == "tiles_planned") {
    return read_tiles(in);
  }
  if (kind == "samples_fixed") {
    return record::SamplesFixed{.job = in.number("job"), .samples = in.number("samples")};
  }
  if (kind == "state_changed") {
    return record::StateChanged{
        .job = in.number("job"), .state = state_field(in, "state"), .reason = in.text("reason")};
  }
  if (kind == "priority_changed") {
    // Stored with an offset, in [0, 2 * kMaxPriority], because fields hold no signed numbers.
    return record::PriorityChanged{
        .job = in.number("job"),
        .priority = static_cast<std::int32_t>(in.number("priority_plus_most", 2 * kMaxPriority)) -
                    kMaxPriority};
  }
  if (kind == "hold_changed") {
    return record::HoldChanged{.job = in.number("job"), .held = in.number("held", 1) == 1};
  }
  if (kind == "time_spent") {
    return record::TimeSpent{.job = in.number("job"), .elapsed_s = in.real("elapsed_s")};
  }
  if (kind == "job_summary" || kind == "figures") {  // "figures": schema versions below 8
    return read_summary(in);
  }
  if (kind == "error_measured") {
    return read_error(in);
  }
  if (kind == "share_counted") {
    return read_share(in);
  }
  if (kind == "failure_log" || kind == "last_words") {  // "last_words": schema versions below 8
    return record::FailureLog{.job = in.number("job"),
                              .worker = in.text("worker"),
                              .log = absl::StrSplit(in.text("log"), '\n', absl::SkipEmpty())};
  }
  if (kind == "job_forgotten") {
    return record::JobForgotten{.job = in.number("job")};
  }
  if (kind == "sequence_added") {
    return read_sequence(in);
  }
  if (kind == "frame_waits") {
    return read_frame(in);
  }
  if (kind == "worker_joined") {
    record::WorkerJoined joined;  // schema versions below 10 lack the field `browser`
    joined.browser = in.next_is("browser") && in.number("browser", 1) == 1;
    joined.instance = in.text("instance");
    return joined;
  }
  if (kind == "worker_left") {
    return record::WorkerLeft{.instance = in.text("instance")};
  }
  if (auto record = read_audit(kind, in)) {
    return *std::move(record);
  }
  in.refuse(absl::StrCat("unknown kind '", kind, "'"));
  return {};
}

}  // namespace

RecordText to_text(const Record& record) {
  FieldWriter out;
  const char* kind =
      std::visit(Overloaded{[&](const record::JobAdded& r) {
                              write_job(out, r);
                              return "job_added";
                            },
                            [&](const record::PassPlanned& r) {
                              out.number("job", r.job);
                              out.number("first", r.samples.first);
                              out.number("last", r.samples.last);
                              return "pass_planned";
                            },
                            [&](const record::TilesPlanned& r) {
                              write_tiles(out, r);
                              return "tiles_planned";
                            },
                            [&](const record::SamplesFixed& r) {
                              out.number("job", r.job);
                              out.number("samples", r.samples);
                              return "samples_fixed";
                            },
                            [&](const record::StateChanged& r) {
                              out.number("job", r.job);
                              out.text("state", name_of(r.state));
                              out.text("reason", r.reason);
                              return "state_changed";
                            },
                            [&](const record::PriorityChanged& r) {
                              out.number("job", r.job);
                              out.number("priority_plus_most",
                                         static_cast<std::uint64_t>(r.priority + kMaxPriority));
                              return "priority_changed";
                            },
                            [&](const record::HoldChanged& r) {
                              out.number("job", r.job);
                              out.number("held", r.held ? 1 : 0);
                              return "hold_changed";
                            },
                            [&](const record::TimeSpent& r) {
                              out.number("job", r.job);
                              out.real("elapsed_s", r.elapsed_s);
                              return "time_spent";
                            },
                            [&](const record::JobSummary& r) {
                              write_summary(out, r);
                              return "job_summary";
                            },
                            [&](const record::ErrorMeasured& r) {
                              write_error(out, r);
                              return "error_measured";
                            },
                            [&](const record::ShareCounted& r) {
                              write_share(out, r);
                              return "share_counted";
                            },
                            [&](const record::FailureLog& r) {
                              out.number("job", r.job);
                              out.text("worker", r.worker);
                              out.text("log", absl::StrJoin(r.log, "\n"));
                              return "failure_log";
                            },
                            [&](const record::JobForgotten& r) {
                              out.number("job", r.job);
                              return "job_forgotten";
                            },
                            [&](const record::SequenceAdded& r) {
                              write_sequence(out, r);
                              return "sequence_added";
                            },
                            [&](const record::FrameWaits& r) {
                              write_frame(out, r);
                              return "frame_waits";
                            },
                            [&](const record::WorkerJoined& r) {
                              out.number("browser", r.browser ? 1 : 0);
                              out.text("instance", r.instance);
                              return "worker_joined";
                            },
                            [&](const record::WorkerLeft& r) {
                              out.text("instance", r.instance);
                              return "worker_left";
                            },
                            [&](const auto& r) -> const char* { return write_audit(out, r); }},
                 record);
  return {.kind = kind, .fields = out.take()};
}

absl::StatusOr<Record> from_text(const RecordText& text) {
  FieldReader in(text.fields);
  Record record = read_record(text.kind, in);
  RETURN_IF_ERROR(in.finish());
  return record;
}

}  // namespace bandsaw::coordinator
