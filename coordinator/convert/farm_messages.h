#pragma once

// Converts the scheduler's values of jobs, frames and workers to messages of farm.proto, and back.
// The server and the dashboard send these messages, the commands receive them.

#include <string>

#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/job_view.h"
#include "proto/farm.pb.h"

namespace bandsaw::coordinator {

farm::StopRule to_message(const StopRule& stop);
/// Returns the stop rule of a message. INVALID_ARGUMENT: the message does not have exactly one
/// rule, has `adaptive` without `error`, or has a value out of range. The error names the field.
/// If a value is out of range, the error also states the value and its range.
absl::StatusOr<StopRule> stop_rule_of(const farm::StopRule& message);

farm::ErrorPoint to_message(const ErrorPoint& point);
ErrorPoint error_point_of(const farm::ErrorPoint& message);

farm::JobStatus to_message(const JobView& job);
/// Returns the job's entry in a list of jobs: to_message(), with the reason cut to 300 bytes.
farm::JobStatus to_list_entry(const JobView& job);
/// Fields of JobView that JobStatus does not have keep their default values. The message has the
/// place of the first bad sample only as a text (bad_sample_at), so this place is missing in the
/// counters of the view.
JobView job_view_of(const farm::JobStatus& message);

farm::WorkerStatus to_message(const WorkerView& worker);
/// The reason is cut to 300 bytes.
farm::Frame to_message(const FrameView& frame);
FrameView frame_view_of(const farm::Frame& message);

/// Returns the place of the first bad sample: "pixel (3, 4), sample 17".
std::string bad_sample_text(const Counters& counters);

}  // namespace bandsaw::coordinator
