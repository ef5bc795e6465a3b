#include "coordinator/cli/progress/progress.h"

#include "absl/strings/str_cat.h"
#include "proto/wire/digest.h"

namespace bandsaw::coordinator {
namespace {

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

StopRule stop_of(const farm::StopRule& stop) {
  const std::uint64_t most = stop.max_samples() > 0 ? stop.max_samples() : kMaxSamples;
  if (stop.error() > 0) {
    return StopAtError{
        .relative_rmse = stop.error(), .max_samples = most, .adaptive = stop.adaptive()};
  }
  if (stop.time_s() > 0) {
    return StopAtTime{.seconds = stop.time_s(), .max_samples = most};
  }
  return StopAtSamples{stop.samples()};
}

RenderSettings settings_of(const farm::Settings& settings) {
  return {.width = settings.width(),
          .height = settings.height(),
          .max_depth = settings.max_depth(),
          .seed = settings.seed(),
          .integrator = static_cast<Integrator>(settings.integrator())};
}

JobWorkerView worker_of(const farm::JobWorker& worker) {
  return {.name = worker.name(),
          .threads = worker.threads(),
          .samples_per_s = worker.samples_per_s(),
          .rows = {worker.first_row(), worker.last_row()},
          .state = worker.state()};
}

ErrorPoint point_of(const farm::ErrorPoint& point) {
  return {.samples = point.samples_per_pixel(),
          .elapsed_s = point.elapsed_s(),
          .cpu_s = point.cpu_s(),
          .estimate = {.mean = point.mean(),
                       .rmse = point.rmse(),
                       .relative_rmse = point.relative_rmse(),
                       .margin = point.margin(),
                       .relative_mse = point.relative_mse(),
                       .median = point.median(),
                       .percentile_95 = point.percentile_95(),
                       .percentile_99 = point.percentile_99(),
                       .worst_share = point.worst_share()}};
}

}  // namespace

Progress progress_of(const farm::JobStatus& status) {
  Progress progress;
  JobView& job = progress.job;
  job.id = status.job();
  job.spec.name = status.name();
  job.spec.settings = settings_of(status.settings());
  job.spec.stop = stop_of(status.stop());
  if (const auto digest = wire::digest_from_raw(status.manifest_sha256()); digest.ok()) {
    job.spec.manifest = digest->hex();
  }
  job.state = state_of(status.state());
  job.reason = status.reason();
  job.fraction = status.fraction();
  job.elapsed_s = status.elapsed_s();
  job.remaining_s = status.remaining_s();
  job.samples_per_s = status.samples_per_s();
  job.samples_done = status.samples_done();
  job.samples_per_pixel = status.samples_per_pixel();
  job.error = status.error();
  job.counters.rays = status.rays();
  job.counters.bad_samples = status.bad_samples();
  job.counters.negative_samples = status.negative_samples();
  job.counters.truncated_paths = status.truncated_paths();
  job.counters.dropped_primitives = status.dropped_primitives();
  job.cpu_s = status.cpu_s();
  job.priority = status.priority();
  job.log_of = status.log_of();
  job.log.assign(status.log().begin(), status.log().end());
  job.workers_used = status.workers_used();
  for (const farm::JobWorker& worker : status.worker()) {
    job.workers.push_back(worker_of(worker));
  }
  for (const farm::ErrorPoint& point : status.curve()) {
    job.curve.push_back(point_of(point));
  }
  for (const farm::WorkerShare& share : status.share()) {
    job.shares.push_back(
        {.name = share.name(), .samples = share.samples(), .cpu_s = share.cpu_s()});
  }
  progress.bad_sample_at = status.bad_sample_at();
  return progress;
}

farm::Settings to_proto(const RenderSettings& settings) {
  farm::Settings out;
  out.set_width(settings.width);
  out.set_height(settings.height);
  out.set_max_depth(settings.max_depth);
  out.set_seed(settings.seed);
  out.set_integrator(static_cast<farm::Integrator>(settings.integrator));
  return out;
}

farm::StopRule to_proto(const StopRule& stop) {
  farm::StopRule out;
  if (const auto* samples = std::get_if<StopAtSamples>(&stop)) {
    out.set_samples(samples->samples);
  } else if (const auto* error = std::get_if<StopAtError>(&stop)) {
    out.set_error(error->relative_rmse);
    out.set_max_samples(error->max_samples);
    out.set_adaptive(error->adaptive);
  } else if (const auto* time = std::get_if<StopAtTime>(&stop)) {
    out.set_time_s(time->seconds);
    out.set_max_samples(time->max_samples);
  }
  return out;
}

std::string bad_sample_text(const Counters& counters) {
  return absl::StrCat("pixel (", counters.bad_x, ", ", counters.bad_y, "), sample ",
                      counters.bad_sample);
}

}  // namespace bandsaw::coordinator
