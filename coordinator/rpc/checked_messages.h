#pragma once

// Converts messages from the network (proto/farm.proto) to the scheduler's values. Every field is
// checked here, against proto/wire/limits.h and renderlib/render/settings.h: INVALID_ARGUMENT names
// the field, its range and the value.

#include "absl/status/statusor.h"
#include "coordinator/scheduler/api/messages.h"
#include "proto/farm.pb.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {

/// Returns the digest with the bytes `raw`. INVALID_ARGUMENT: `raw` is not 32 bytes long. `field`:
/// the name of the field in errors.
absl::StatusOr<wire::Digest> digest_field(const char* field, const std::string& raw);
absl::StatusOr<JobSpec> job_spec(const farm::SubmitRequest& request);
absl::StatusOr<SequenceSpec> sequence_spec(const farm::SubmitSequenceRequest& request);
absl::StatusOr<std::vector<FrameScene>> frame_scenes(const farm::AddFramesRequest& request);
/// Returns the frames in ascending order, each once.
absl::StatusOr<std::vector<FrameNumber>> frame_numbers(const farm::RetryFramesRequest& request);
/// Checks the ranges of rows and samples. The engine decides whether the band belongs to its job.
/// `field`: the name of the field in errors.
absl::StatusOr<Band> band(const char* field, const farm::Band& message);
/// `address`: the peer's address, for display.
absl::StatusOr<WorkerHello> worker_hello(const farm::Hello& message, std::string address);
/// In the results of heartbeat() and band_failed(), `session` is not set.
absl::StatusOr<input::Heartbeat> heartbeat(const farm::Heartbeat& message);
/// Checks the number of lines, the length of each line, and that no line has control characters.
absl::StatusOr<std::vector<std::string>> log_lines(
    const char* field, const google::protobuf::RepeatedPtrField<std::string>& lines);
absl::StatusOr<input::BandFailed> band_failed(const farm::BandFailed& message);
/// Checks a text for display: its length, and that it has no control characters.
absl::StatusOr<std::string> reason_field(const char* field, const std::string& text);

}  // namespace bandsaw::coordinator
