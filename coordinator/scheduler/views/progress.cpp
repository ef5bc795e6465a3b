// Computes the fraction of a job that is done, its remaining time, and its workers. The remaining
// time is the thread time of all samples that are not stored yet, divided by the number of threads
// that work on the job. The times per row come from measurements (RowTimes).

#include "coordinator/scheduler/views/progress.h"

#include <algorithm>
#include <map>
#include <optional>

#include "coordinator/scheduler/model/pass_plan.h"

namespace bandsaw::coordinator {
namespace {

/// Returns the samples per pixel after which the job is expected to end. If no end can be
/// predicted, this is the job's maximum.
double expected_samples(const Job& job) {
  if (job.fixed_samples) {
    return static_cast<double>(*job.fixed_samples);
  }
  const auto max = static_cast<double>(job.max_samples());
  const auto* rule = std::get_if<StopAtError>(&job.spec.stop);
  const auto end = rule == nullptr ? std::nullopt
                                   : expected_end(job.curve, rule->relative_rmse,
                                                  job.planned_samples(), job.max_samples());
  return end ? static_cast<double>(*end) : max;
}

/// Returns the pixel samples of the whole job, done and to come. In an adaptive job a pass takes a
/// share of the samples of uniform sampling. A pass that is not planned yet is assumed to have the
/// share of the last planned pass.
double expected_work(const Job& job) {
  const double beyond = expected_samples(job) - static_cast<double>(job.planned_samples());
  double per_pixel = beyond * (job.passes.empty() ? 1 : job.passes.back().mean_share());
  for (const Pass& pass : job.passes) {
    per_pixel += static_cast<double>(pass.samples.samples()) * pass.mean_share();
  }
  return per_pixel * static_cast<double>(job.pixels());
}

/// Returns the thread time, in seconds, of the samples that are not leased yet.
double time_of_free(const Job& job) {
  const std::uint32_t height = job.spec.settings.height;
  const double beyond = expected_samples(job) - static_cast<double>(job.planned_samples());
  const double share = job.passes.empty() ? 1 : job.passes.back().mean_share();
  // `column_s` is the thread time, in seconds, of one column of pixels.
  double column_s = std::max(0.0, beyond) * share * job.row_times.of_all();
  for (const Pass& pass : job.passes) {
    // Rows are leased from the top. So the free samples are assumed to be spread evenly over the
    // rows from the first free row to the bottom.
    if (const auto free = pass.coverage.free_from(0)) {
      const RowRange below{free->rows.first, height};
      column_s += static_cast<double>(pass.coverage.free_samples()) *
                  job.row_times.of(below, pass.tile_row_shares) / below.count();
    }
  }
  return column_s * job.spec.settings.width;
}

/// Returns the remaining thread time, in seconds, of the leases that own rows: those that are
/// neither backup tasks nor audits.
double time_of_leased(const Context& context, const Job& job, Time now) {
  double sum = 0;
  for (const LeaseId id : job.leases) {
    const Lease& lease = *context.leases.find(id);
    if (lease.backup_of != 0 || lease.audit) {
      continue;
    }
    const Worker& worker = *context.workers.by_id(lease.worker);
    const double takes =
        static_cast<double>(lease.band.samples.samples()) * job.spec.settings.width *
        job.row_times.of(lease.band.rows, job.pass_of(lease.band)->tile_row_shares);
    // A worker renders the band of its first lease. It has not begun its other leases.
    const double passed = worker.leases.front() == id ? (now - lease.begun_at) * worker.threads : 0;
    sum += std::clamp(takes - passed, 0.0, takes);
  }
  return sum;
}

/// Returns the threads that work on the job. A worker's threads are divided evenly among its
/// leases, which may be of several jobs.
double threads_on(const Context& context, const Job& job) {
  double sum = 0;
  for (const LeaseId id : job.leases) {
    const Worker& worker = *context.workers.by_id(context.leases.find(id)->worker);
    sum += static_cast<double>(worker.threads) / static_cast<double>(worker.leases.size());
  }
  return sum;
}

}  // namespace

double fraction_done(const Job& job, Time now) {
  if (job.state == JobState::kDone) {
    return 1;
  }
  const auto* error = std::get_if<StopAtError>(&job.spec.stop);
  if (const auto* rule = std::get_if<StopAtTime>(&job.spec.stop); rule && !job.fixed_samples) {
    return std::clamp(job.elapsed(now) / rule->seconds, 0.0, 1.0);
  }
  if (error != nullptr && !job.fixed_samples && job.error < 0) {
    return 0;
  }
  const double all = expected_work(job);
  return std::clamp(static_cast<double>(job.totals().samples) / all, 0.0, 1.0);
}

double remaining_s(const Context& context, const Job& job, Time now) {
  if (is_final(job.state)) {
    return 0;
  }
  if (const auto* rule = std::get_if<StopAtTime>(&job.spec.stop); rule && !job.fixed_samples) {
    return job.clock.runs() ? std::max(0.0, rule->seconds - job.elapsed(now)) : -1;
  }
  if (job.complete()) {
    return 0;
  }
  const bool unknown =
      std::holds_alternative<StopAtError>(job.spec.stop) && !job.fixed_samples && job.error < 0;
  const double threads = threads_on(context, job);
  return unknown || threads <= 0 || !job.row_times.measured()
             ? -1
             : (time_of_free(job) + time_of_leased(context, job, now)) / threads;
}

std::vector<JobWorkerView> workers_on(const Context& context, const Job& job) {
  std::map<WorkerId, const Lease*> oldest;
  for (const LeaseId id : job.leases) {
    const Worker& worker = *context.workers.by_id(context.leases.find(id)->worker);
    const auto first = std::find_if(worker.leases.begin(), worker.leases.end(), [&](LeaseId held) {
      return context.leases.find(held)->job == job.id;
    });
    oldest[worker.id] = context.leases.find(*first);
  }
  std::vector<JobWorkerView> views;
  for (const auto& [id, lease] : oldest) {
    const Worker& worker = *context.workers.by_id(id);
    const auto on_job = worker.on_job.find(job.id);
    views.push_back({worker.name, worker.threads,
                     on_job == worker.on_job.end() ? 0 : on_job->second.speed.mean(),
                     lease->band.rows, worker.doing.empty() ? "rendering" : worker.doing});
  }
  std::sort(views.begin(), views.end(),
            [](const JobWorkerView& a, const JobWorkerView& b) { return a.name < b.name; });
  return views;
}

}  // namespace bandsaw::coordinator
