// Writes progress as the JSON objects of --json (coordinator/README.md, "Progress for programs").
// known_number() writes null for a negative value, which stands for an unknown one.

#include "coordinator/cli/progress/progress_json.h"

#include "coordinator/scheduler/api/job_spec.h"

namespace bandsaw::coordinator {
namespace {

JsonObject worker_json(const JobWorkerView& worker) {
  JsonObject out;
  out.text("name", worker.name)
      .whole("threads", worker.threads)
      .number("samples_per_s", worker.samples_per_s)
      .whole("first_row", worker.rows.first)
      .whole("last_row", worker.rows.last)
      .text("state", worker.state);
  return out;
}

}  // namespace

void add_stop(JsonObject& out, const StopRule& stop) {
  if (const auto* samples = std::get_if<StopAtSamples>(&stop)) {
    out.whole("stop_samples", samples->samples);
  } else if (const auto* error = std::get_if<StopAtError>(&stop)) {
    out.number("stop_error", error->relative_rmse);
  } else if (const auto* time = std::get_if<StopAtTime>(&stop)) {
    out.number("stop_time_s", time->seconds);
  }
}

JsonObject progress_json(const Progress& progress, const std::string& event) {
  const JobView& job = progress.job;
  JsonObject out;
  out.text("event", event);
  if (job.id > 0) {
    out.whole("job", job.id);
  }
  out.text("name", job.spec.name)
      .text("state", state_name(job.state))
      .text("reason", job.reason)
      .whole("width", job.spec.settings.width)
      .whole("height", job.spec.settings.height);
  add_stop(out, job.spec.stop);
  out.number("fraction", job.fraction)
      .number("elapsed_s", job.elapsed_s)
      .known_number("remaining_s", job.remaining_s)
      .number("samples_per_s", job.samples_per_s)
      .whole("samples_done", job.samples_done)
      .whole("samples_per_pixel", job.samples_per_pixel)
      .known_number("error", job.error);
  if (progress.clean_error >= 0) {
    out.number("clean_error", progress.clean_error);
  }
  out.whole("rays", job.counters.rays)
      .number("cpu_s", job.cpu_s)
      .whole("bad_samples", job.counters.bad_samples);
  if (job.counters.bad_samples > 0) {
    out.text("bad_sample_at", progress.bad_sample_at);
  }
  if (!job.log.empty()) {
    out.text("log_of", job.log_of).texts("log", job.log);
  }
  if (progress.threads > 0) {  // a render on this machine, which has no workers
    return out.whole("threads", static_cast<std::uint64_t>(progress.threads));
  }
  if (job.has_frames()) {
    out.whole("frames", job.frames.all())
        .whole("frames_done", job.frames.of(FrameState::kDone))
        .whole("frames_failed", job.frames.of(FrameState::kFailed));
  }
  std::vector<JsonObject> workers;
  for (const JobWorkerView& worker : job.workers) {
    workers.push_back(worker_json(worker));
  }
  return out.number("priority", job.priority)
      .whole("workers_used", job.workers_used)
      .objects("workers", workers);
}

}  // namespace bandsaw::coordinator
