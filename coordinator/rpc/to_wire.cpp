#include "coordinator/rpc/convert.h"
#include "renderlib/base/status_macros.h"

namespace bandsaw::coordinator {
namespace {

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

void set_settings(const RenderSettings& settings, farm::Settings& message) {
  message.set_width(settings.width);
  message.set_height(settings.height);
  message.set_max_depth(settings.max_depth);
  message.set_seed(settings.seed);
  message.set_integrator(static_cast<farm::Integrator>(settings.integrator));
}

struct SetStop {
  farm::StopRule& message;
  void operator()(const StopAtSamples& stop) const { message.set_samples(stop.samples); }
  void operator()(const StopAtError& stop) const {
    message.set_error(stop.relative_rmse);
    message.set_max_samples(stop.max_samples);
    message.set_adaptive(stop.adaptive);
  }
  void operator()(const StopAtTime& stop) const {
    message.set_time_s(stop.seconds);
    message.set_max_samples(stop.max_samples);
  }
};

std::string raw_digest(const DigestHex& hex) {
  const absl::StatusOr<wire::Digest> digest = wire::digest_from_hex(hex);
  return digest.ok() ? digest->raw() : std::string();
}

}  // namespace

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

farm::JobStatus to_message(const JobView& job) {
  farm::JobStatus message;
  message.set_job(job.id);
  message.set_name(job.spec.name);
  message.set_state(to_message(job.state));
  message.set_reason(job.reason);
  set_settings(job.spec.settings, *message.mutable_settings());
  std::visit(SetStop{*message.mutable_stop()}, job.spec.stop);
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
    message.set_bad_sample_at("pixel (" + std::to_string(job.counters.bad_x) + ", " +
                              std::to_string(job.counters.bad_y) + "), sample " +
                              std::to_string(job.counters.bad_sample));
  }
  message.set_negative_samples(job.counters.negative_samples);
  message.set_truncated_paths(job.counters.truncated_paths);
  message.set_dropped_primitives(job.counters.dropped_primitives);
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
  for (const WorkerShare& share : job.shares) {
    farm::WorkerShare* s = message.add_share();
    s->set_name(share.name);
    s->set_samples(share.samples);
    s->set_cpu_s(share.cpu_s);
  }
  return message;
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
  return message;
}

farm::ToWorker to_message(const action::Welcome& welcome, const std::string& epoch) {
  farm::ToWorker message;
  message.mutable_welcome()->set_name(welcome.name);
  message.mutable_welcome()->set_heartbeat_ms(welcome.heartbeat_ms);
  message.mutable_welcome()->set_epoch(epoch);
  return message;
}

farm::ToWorker to_message(const action::Refuse& refuse) {
  farm::ToWorker message;
  message.mutable_refused()->set_reason(refuse.reason);
  message.mutable_refused()->set_retry_after_ms(refuse.retry_after_ms);
  return message;
}

absl::StatusOr<farm::ToWorker> to_message(const action::Lease& lease) {
  ASSIGN_OR_RETURN(const wire::Digest manifest, wire::digest_from_hex(lease.manifest));
  farm::ToWorker message;
  farm::Lease* l = message.mutable_lease();
  l->set_lease(lease.lease);
  l->set_job(lease.job);
  l->set_manifest_sha256(manifest.raw());
  set_settings(lease.settings, *l->mutable_settings());
  l->mutable_band()->set_first_sample(lease.band.samples.first);
  l->mutable_band()->set_last_sample(lease.band.samples.last);
  l->mutable_band()->set_first_row(lease.band.rows.first);
  l->mutable_band()->set_last_row(lease.band.rows.last);
  for (const std::uint32_t number : lease.tiles.numbers()) {
    l->add_tile_samples(number);
  }
  l->set_attempt(lease.attempt);
  return message;
}

farm::ToWorker to_message(const action::Revoke& revoke) {
  farm::ToWorker message;
  for (const LeaseId lease : revoke.leases) {
    message.mutable_revoke()->add_lease(lease);
  }
  return message;
}

}  // namespace bandsaw::coordinator
