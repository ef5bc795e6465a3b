// Converts the coordinator's values to messages of the protocol between farm and users, and back.
// to_message() converts a value to a message; functions whose names end in _of convert a message to
// a value. The C++ enum FrameState and the enum of farm.proto have the same numbers, so a
// FrameState is converted by a cast.

#include "coordinator/convert/farm_messages.h"

#include <cmath>

#include "absl/strings/str_cat.h"
#include "proto/convert/render_values.h"
#include "proto/wire/digest.h"
#include "renderlib/base/clean_text.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {

static_assert(static_cast<int>(FrameState::kExpected) == farm::FRAME_STATE_EXPECTED &&
              static_cast<int>(FrameState::kWaiting) == farm::FRAME_STATE_WAITING &&
              static_cast<int>(FrameState::kRendering) == farm::FRAME_STATE_RENDERING &&
              static_cast<int>(FrameState::kDone) == farm::FRAME_STATE_DONE &&
              static_cast<int>(FrameState::kFailed) == farm::FRAME_STATE_FAILED);

namespace {

/// Maximum bytes of the reason in an entry of a list of jobs or frames.
constexpr std::size_t kListedReasonBytes = 300;

void add_frames(const JobView& job, farm::JobStatus& message) {
  message.set_sequence(job.spec.sequence);
  message.set_frame(job.spec.frame);
  if (job.has_frames()) {
    farm::FrameCounts& counts = *message.mutable_frames();
    counts.set_expected(static_cast<std::uint32_t>(job.frames.of(FrameState::kExpected)));
    counts.set_waiting(static_cast<std::uint32_t>(job.frames.of(FrameState::kWaiting)));
    counts.set_rendering(static_cast<std::uint32_t>(job.frames.of(FrameState::kRendering)));
    counts.set_done(static_cast<std::uint32_t>(job.frames.of(FrameState::kDone)));
    counts.set_failed(static_cast<std::uint32_t>(job.frames.of(FrameState::kFailed)));
  }
}

void read_frames(const farm::JobStatus& message, JobView& job) {
  job.spec.sequence = message.sequence();
  job.spec.frame = message.frame();
  const farm::FrameCounts& counts = message.frames();
  job.frames = {
      {counts.expected(), counts.waiting(), counts.rendering(), counts.done(), counts.failed()}};
}

template <class... Parts>
absl::Status invalid(const char* field, const Parts&... parts) {
  return absl::InvalidArgumentError(absl::StrCat(field, ": ", parts...));
}

absl::Status check_samples(const char* field, std::uint64_t value, std::uint64_t min) {
  if (value < min || value > kMaxSamples) {
    return invalid(field, "must lie in [", min, ", ", kMaxSamples, "], is ", value);
  }
  return absl::OkStatus();
}

farm::JobState to_message(JobState state) {
  switch (state) {
    case JobState::kRunning:
      return farm::JOB_STATE_RUNNING;
    case JobState::kPaused:
      return farm::JOB_STATE_PAUSED;
    case JobState::kFinishing:
      return farm::JOB_STATE_FINISHING;
    case JobState::kDone:
      return farm::JOB_STATE_DONE;
    case JobState::kFailed:
      return farm::JOB_STATE_FAILED;
    case JobState::kCancelled:
      return farm::JOB_STATE_CANCELLED;
  }
  return farm::JOB_STATE_UNSPECIFIED;
}

JobState state_of(farm::JobState state) {
  switch (state) {
    case farm::JOB_STATE_PAUSED:
      return JobState::kPaused;
    case farm::JOB_STATE_FINISHING:
      return JobState::kFinishing;
    case farm::JOB_STATE_DONE:
      return JobState::kDone;
    case farm::JOB_STATE_FAILED:
      return JobState::kFailed;
    case farm::JOB_STATE_CANCELLED:
      return JobState::kCancelled;
    default:
      return JobState::kRunning;
  }
}

JobWorkerView worker_of(const farm::JobWorker& worker) {
  return {.name = worker.name(),
          .threads = worker.threads(),
          .samples_per_s = worker.samples_per_s(),
          .rows = {worker.first_row(), worker.last_row()},
          .state = worker.state()};
}

/// Returns the 32 bytes of a digest. Returns an empty string if `hex` is no digest.
std::string raw_digest(const DigestHex& hex) {
  const absl::StatusOr<wire::Digest> digest = wire::digest_from_hex(hex);
  return digest.ok() ? digest->raw() : std::string();
}

}  // namespace

farm::StopRule to_message(const StopRule& stop) {
  farm::StopRule message;
  if (const auto* samples = std::get_if<StopAtSamples>(&stop)) {
    message.set_samples(samples->samples);
  } else if (const auto* error = std::get_if<StopAtError>(&stop)) {
    message.set_error(error->relative_rmse);
    message.set_max_samples(error->max_samples);
    message.set_adaptive(error->adaptive);
  } else if (const auto* time = std::get_if<StopAtTime>(&stop)) {
    message.set_time_s(time->seconds);
    message.set_max_samples(time->max_samples);
  }
  return message;
}

absl::StatusOr<StopRule> stop_rule_of(const farm::StopRule& message) {
  const int given = (message.samples() != 0) + (message.error() != 0) + (message.time_s() != 0);
  if (given != 1) {
    return invalid("stop", "exactly one of samples, error, time_s must be given, not ", given);
  }
  if (message.adaptive() && message.error() == 0) {
    return invalid("stop.adaptive", "only with error");
  }
  RETURN_IF_ERROR(check_samples("stop.max_samples", message.max_samples(), 0));
  const std::uint64_t most = message.max_samples() != 0 ? message.max_samples() : kMaxSamples;
  if (message.samples() != 0) {
    RETURN_IF_ERROR(check_samples("stop.samples", message.samples(), 1));
    return StopAtSamples{message.samples()};
  }
  const double value = message.error() != 0 ? message.error() : message.time_s();
  const char* field = message.error() != 0 ? "stop.error" : "stop.time_s";
  if (!std::isfinite(value) || value <= 0) {
    return invalid(field, "must be > 0 and finite, is ", value);
  }
  if (message.error() != 0) {
    return StopAtError{.relative_rmse = value, .max_samples = most, .adaptive = message.adaptive()};
  }
  return StopAtTime{.seconds = value, .max_samples = most};
}

farm::ErrorPoint to_message(const ErrorPoint& point) {
  farm::ErrorPoint message;
  message.set_samples_per_pixel(point.samples);
  message.set_elapsed_s(point.elapsed_s);
  message.set_cpu_s(point.cpu_s);
  message.set_mean(point.estimate.mean);
  message.set_rmse(point.estimate.rmse);
  message.set_relative_rmse(point.estimate.relative_rmse);
  message.set_margin(point.estimate.margin);
  message.set_relative_mse(point.estimate.relative_mse);
  message.set_median(point.estimate.median);
  message.set_percentile_95(point.estimate.percentile_95);
  message.set_percentile_99(point.estimate.percentile_99);
  message.set_worst_share(point.estimate.worst_share);
  return message;
}

ErrorPoint error_point_of(const farm::ErrorPoint& message) {
  return {.samples = message.samples_per_pixel(),
          .elapsed_s = message.elapsed_s(),
          .cpu_s = message.cpu_s(),
          .estimate = {.mean = message.mean(),
                       .rmse = message.rmse(),
                       .relative_rmse = message.relative_rmse(),
                       .margin = message.margin(),
                       .relative_mse = message.relative_mse(),
                       .median = message.median(),
                       .percentile_95 = message.percentile_95(),
                       .percentile_99 = message.percentile_99(),
                       .worst_share = message.worst_share()}};
}

farm::JobStatus to_message(const JobView& job) {
  farm::JobStatus message;
  message.set_job(job.id);
  message.set_name(job.spec.name);
  message.set_state(to_message(job.state));
  message.set_reason(job.reason);
  *message.mutable_settings() = bandsaw::to_message(job.spec.settings);
  *message.mutable_stop() = to_message(job.spec.stop);
  message.set_fraction(job.fraction);
  message.set_elapsed_s(job.elapsed_s);
  message.set_remaining_s(job.remaining_s);
  message.set_samples_per_s(job.samples_per_s);
  message.set_samples_done(job.samples_done);
  message.set_error(job.error);
  message.set_samples_per_pixel(job.samples_per_pixel);
  for (const JobWorkerView& worker : job.workers) {
    farm::JobWorker* w = message.add_worker();
    w->set_name(worker.name);
    w->set_threads(worker.threads);
    w->set_samples_per_s(worker.samples_per_s);
    w->set_first_row(worker.rows.first);
    w->set_last_row(worker.rows.last);
    w->set_state(worker.state);
  }
  message.set_workers_used(job.workers_used);
  message.set_bands_audited(job.bands_audited);
  message.set_rays(job.counters.rays);
  message.set_bad_samples(job.counters.bad_samples);
  if (job.counters.bad_samples > 0) {
    message.set_bad_sample_at(bad_sample_text(job.counters));
  }
  message.set_negative_samples(job.counters.negative_samples);
  message.set_truncated_paths(job.counters.truncated_paths);
  message.set_dropped_primitives(job.counters.dropped_primitives);
  message.set_techniques(job.counters.techniques);
  message.set_training_rays(job.counters.training_rays);
  message.set_manifest_sha256(raw_digest(job.spec.manifest));
  message.set_cpu_s(job.cpu_s);
  message.set_priority(job.priority);
  message.set_log_of(job.log_of);
  for (const std::string& line : job.log) {
    message.add_log(line);
  }
  for (const ErrorPoint& point : job.curve) {
    *message.add_curve() = to_message(point);
  }
  add_frames(job, message);
  for (const WorkerShare& share : job.shares) {
    farm::WorkerShare* s = message.add_share();
    s->set_name(share.name);
    s->set_samples(share.samples);
    s->set_cpu_s(share.cpu_s);
  }
  return message;
}

farm::JobStatus to_list_entry(const JobView& job) {
  farm::JobStatus message = to_message(job);
  message.set_reason(clean_text(job.reason, kListedReasonBytes));
  return message;
}

farm::Frame to_message(const FrameView& frame) {
  farm::Frame message;
  message.set_frame(frame.number);
  message.set_state(static_cast<farm::FrameState>(frame.state));
  message.set_job(frame.job);
  message.set_reason(clean_text(frame.reason, kListedReasonBytes));
  message.set_changed(frame.changed);
  return message;
}

FrameView frame_view_of(const farm::Frame& message) {
  const bool known = message.state() >= 0 && message.state() < static_cast<int>(kFrameStates);
  return {.number = message.frame(),
          .state = known ? static_cast<FrameState>(message.state()) : FrameState::kExpected,
          .job = message.job(),
          .reason = message.reason(),
          .changed = message.changed()};
}

farm::WorkerStatus to_message(const WorkerView& worker) {
  farm::WorkerStatus message;
  message.set_name(worker.name);
  message.set_state(worker.state);
  message.set_reason(worker.reason);
  message.set_threads(worker.threads);
  message.set_samples_per_s(worker.samples_per_s);
  message.set_job(worker.job);
  message.set_address(worker.address);
  message.set_build(worker.build);
  message.set_connected_s(worker.connected_s);
  message.set_browser(worker.browser);
  return message;
}

JobView job_view_of(const farm::JobStatus& message) {
  JobView job;
  job.id = message.job();
  job.spec.name = message.name();
  job.spec.settings = settings_of(message.settings());
  // An invalid stop rule is replaced by its number of samples.
  job.spec.stop = stop_rule_of(message.stop()).value_or(StopAtSamples{message.stop().samples()});
  if (const auto digest = wire::digest_from_raw(message.manifest_sha256()); digest.ok()) {
    job.spec.manifest = digest->hex();
  }
  job.state = state_of(message.state());
  job.reason = message.reason();
  job.fraction = message.fraction();
  job.elapsed_s = message.elapsed_s();
  job.remaining_s = message.remaining_s();
  job.samples_per_s = message.samples_per_s();
  job.samples_done = message.samples_done();
  job.samples_per_pixel = message.samples_per_pixel();
  job.error = message.error();
  job.counters.rays = message.rays();
  job.counters.bad_samples = message.bad_samples();
  job.counters.negative_samples = message.negative_samples();
  job.counters.truncated_paths = message.truncated_paths();
  job.counters.dropped_primitives = message.dropped_primitives();
  job.counters.techniques = message.techniques();
  job.counters.training_rays = message.training_rays();
  job.cpu_s = message.cpu_s();
  job.priority = message.priority();
  job.log_of = message.log_of();
  job.log.assign(message.log().begin(), message.log().end());
  job.workers_used = message.workers_used();
  job.bands_audited = message.bands_audited();
  read_frames(message, job);
  for (const farm::JobWorker& worker : message.worker()) {
    job.workers.push_back(worker_of(worker));
  }
  for (const farm::ErrorPoint& point : message.curve()) {
    job.curve.push_back(error_point_of(point));
  }
  for (const farm::WorkerShare& share : message.share()) {
    job.shares.push_back(
        {.name = share.name(), .samples = share.samples(), .cpu_s = share.cpu_s()});
  }
  return job;
}

std::string bad_sample_text(const Counters& counters) {
  return absl::StrCat("pixel (", counters.bad_x, ", ", counters.bad_y, "), sample ",
                      counters.bad_sample);
}

}  // namespace bandsaw::coordinator
