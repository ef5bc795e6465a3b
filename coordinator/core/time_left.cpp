// How long a job will take yet: what its rows took, for all that is to come of them, over the
// threads that are at it.

#include <algorithm>

#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

double Core::State::remaining(const Job& job, Time now) const {
  if (is_final(job.state)) {
    return 0;
  }
  if (const auto* rule = std::get_if<StopAtTime>(&job.spec.stop); rule && !job.fixed) {
    return job.first_lease_at ? std::max(0.0, rule->seconds - elapsed(job, now)) : -1;
  }
  if (job.complete()) {
    return 0;
  }
  const bool unknown =
      std::holds_alternative<StopAtError>(job.spec.stop) && !job.fixed && job.error < 0;
  const double threads = threads_at(job);
  return unknown || threads <= 0 || !job.row_times.measured()
             ? -1
             : (time_of_free(job) + time_of_leased(job, now)) / threads;
}

double Core::State::time_of_free(const Job& job) const {
  const std::uint32_t height = job.spec.settings.height;
  const double beyond = expected_samples(job) - static_cast<double>(job.planned_samples());
  const double share = job.passes.empty() ? 1 : job.passes.back().share();
  double columns = std::max(0.0, beyond) * share * job.row_times.of_all();
  for (const Pass& pass : job.passes) {
    // Rows are given out from the top: those below the first free one are taken to be free alike.
    if (const auto free = pass.coverage.free_from(0)) {
      const RowRange below{free->rows.first, height};
      columns += static_cast<double>(pass.coverage.free_samples()) *
                 job.row_times.of(below, pass.shares) / below.count();
    }
  }
  return columns * job.spec.settings.width;
}

double Core::State::time_of_leased(const Job& job, Time now) const {
  double sum = 0;
  for (const LeaseId id : job.leases) {
    const Lease& lease = *leases_.find(id);
    if (lease.copy_of != 0 || lease.audit) {
      continue;
    }
    const Worker& worker = *workers_.by_id(lease.worker);
    const double takes = static_cast<double>(lease.band.samples.samples()) *
                         job.spec.settings.width *
                         job.row_times.of(lease.band.rows, job.pass_of(lease.band)->shares);
    const double passed = worker.leases.front() == id ? (now - lease.begun_at) * worker.threads : 0;
    sum += std::clamp(takes - passed, 0.0, takes);
  }
  return sum;
}

double Core::State::threads_at(const Job& job) const {
  double sum = 0;
  for (const LeaseId id : job.leases) {
    const Worker& worker = *workers_.by_id(leases_.find(id)->worker);
    sum += static_cast<double>(worker.threads) / static_cast<double>(worker.leases.size());
  }
  return sum;
}

}  // namespace bandsaw::coordinator
