// What is shown of jobs and workers.

#include <algorithm>
#include <cmath>

#include "absl/strings/str_cat.h"
#include "coordinator/core/pass_plan.h"
#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

std::optional<JobView> Core::State::view(JobId id, Time now) const {
  const Job* job = find(id);
  if (job == nullptr) {
    return std::nullopt;
  }
  const Totals totals = job->totals();
  JobView view;
  view.id = id;
  view.spec = job->spec;
  view.state = job->state;
  view.reason = !job->reason.empty() ? job->reason : waiting_reason(*job);
  if (view.reason.empty()) {
    view.reason = job->damage;
  }
  view.elapsed_s = elapsed(*job, std::max(now, clock_.wall()));
  view.fraction = fraction(*job, now);
  view.remaining_s = remaining(*job, now);
  view.samples_per_s = is_final(job->state) ? 0 : job->throughput.per_second(now);
  view.samples_done = totals.samples;
  const bool uneven = job->tile_plan || (is_final(job->state) && is_adaptive(job->spec.stop));
  view.samples_per_pixel = uneven ? totals.samples / job->pixels() : job->complete_samples();
  view.error = is_final(job->state) && job->figures ? job->figures->error : job->error;
  view.counters = totals.counters;
  view.cpu_s = totals.cpu_s;
  view.workers_used = is_final(job->state) && job->figures
                          ? job->figures->workers_used
                          : static_cast<std::uint32_t>(job->shares.size());
  view.priority = job->priority;
  if (job->state == JobState::kFailed) {
    view.log_of = job->log_of;
    view.log = job->log;
  }
  view.bands_copied = job->bands_copied;
  view.bands_audited = job->audited.size();
  view.workers = lines(*job);
  view.curve = job->curve;
  view.shares = job->final_shares;
  return view;
}

std::vector<JobView> Core::State::job_views(Time now) const {
  std::vector<JobView> views;
  for (const auto& [id, job] : jobs_) {
    views.push_back(*view(id, now));
    views.back().curve.clear();
    views.back().log.clear();
    views.back().shares.clear();
  }
  return views;
}

std::vector<JobWorkerView> Core::State::lines(const Job& job) const {
  std::map<WorkerId, const Lease*> oldest;
  for (const LeaseId id : job.leases) {
    const Lease* lease = leases_.find(id);
    const Worker& worker = *workers_.by_id(lease->worker);
    const auto first = std::find_if(worker.leases.begin(), worker.leases.end(), [&](LeaseId held) {
      return leases_.find(held)->job == job.id;
    });
    oldest[worker.id] = leases_.find(*first);
  }
  std::vector<JobWorkerView> lines;
  for (const auto& [id, lease] : oldest) {
    const Worker& worker = *workers_.by_id(id);
    const auto on_job = worker.on_job.find(job.id);
    lines.push_back({worker.name, worker.threads,
                     on_job == worker.on_job.end() ? 0 : on_job->second.speed.mean(),
                     lease->band.rows, worker.doing.empty() ? "rendering" : worker.doing});
  }
  std::sort(lines.begin(), lines.end(),
            [](const JobWorkerView& a, const JobWorkerView& b) { return a.name < b.name; });
  return lines;
}

double Core::State::expected_samples(const Job& job) const {
  if (job.fixed) {
    return static_cast<double>(*job.fixed);
  }
  const auto most = static_cast<double>(job.max_samples());
  const auto* rule = std::get_if<StopAtError>(&job.spec.stop);
  const auto end = rule == nullptr ? std::nullopt
                                   : expected_end(job.curve, rule->relative_rmse,
                                                  job.planned_samples(), job.max_samples());
  return end ? static_cast<double>(*end) : most;
}

/// In pixel samples: those of passes that are not planned yet as those of the last.
double Core::State::expected_work(const Job& job) const {
  const double beyond = expected_samples(job) - static_cast<double>(job.planned_samples());
  double columns = beyond * (job.passes.empty() ? 1 : job.passes.back().share());
  for (const Pass& pass : job.passes) {
    columns += static_cast<double>(pass.samples.samples()) * pass.share();
  }
  return columns * static_cast<double>(job.pixels());
}

double Core::State::fraction(const Job& job, Time now) const {
  if (job.state == JobState::kDone) {
    return 1;
  }
  const auto* error = std::get_if<StopAtError>(&job.spec.stop);
  if (const auto* rule = std::get_if<StopAtTime>(&job.spec.stop); rule && !job.fixed) {
    return std::clamp(elapsed(job, now) / rule->seconds, 0.0, 1.0);
  }
  if (error != nullptr && !job.fixed && job.error < 0) {
    return 0;
  }
  const double all = expected_work(job);
  return std::clamp(static_cast<double>(job.totals().samples) / all, 0.0, 1.0);
}

std::vector<WorkerView> Core::State::worker_views(Time now) const {
  std::vector<WorkerView> views;
  for (const auto& [id, worker] : workers_.all()) {
    const char* const state = worker.quarantined      ? "quarantined"
                              : !worker.session       ? "lost"
                              : worker.draining       ? "draining"
                              : worker.leases.empty() ? "idle"
                                                      : "rendering";
    WorkerView view;
    view.name = worker.name;
    view.state = state;
    view.reason = worker.reason;
    view.address = worker.address;
    view.build = worker.build;
    view.threads = worker.threads;
    view.samples_per_s = worker.speed.mean();
    view.job = worker.leases.empty() ? 0 : leases_.find(worker.leases.front())->job;
    view.connected_s = worker.session ? std::max(0.0, now - worker.connected_at) : 0;
    views.push_back(std::move(view));
  }
  for (const Refusal& refusal : refusals_) {
    views.push_back(refusal.worker);
  }
  for (WorkerView& view : quarantined_views()) {
    views.push_back(std::move(view));
  }
  std::sort(views.begin(), views.end(),
            [](const WorkerView& a, const WorkerView& b) { return a.name < b.name; });
  return views;
}

}  // namespace bandsaw::coordinator
