#include "coordinator/scheduler/dispatch/dispatcher.h"

#include <algorithm>

namespace bandsaw::coordinator {

void Dispatcher::assign() {
  lease_free();
  while (backups_.share()) {
    lease_free();
  }
}

/// Gives each worker with a spare credit one lease. A worker that can hold more comes again later
/// in the order, because it has more leases then.
void Dispatcher::lease_free() {
  const AvailableWorkers& available = context_.available;
  for (auto place = available.first_after(std::nullopt); place && !context_.jobs.leasable().empty();
       place = available.first_after(place)) {
    lease_to(*context_.workers.by_id(place->second));
  }
}

/// Grants the worker one lease, if there is one for it. A suspect band is given only to a worker
/// that holds nothing else: if that worker is lost as well, the crash is attributed to the band.
void Dispatcher::lease_to(Worker& worker) {
  if (holds_suspect(worker)) {
    return;
  }
  const auto& leasable = context_.jobs.leasable();
  for (auto it = leasable.begin(); it != leasable.end();) {
    Job& job = context_.jobs.at(it->second);
    ++it;
    if (!job.any_free() && !planner_.plan_timed(job) && !job.audit_waits()) {
      context_.jobs.unmark_leasable(job);
      continue;
    }
    if (!eligibility_.may_render(worker, job)) {
      continue;
    }
    if (Audit* audit = audits_.next_for(worker, job)) {
      audits_.grant(worker, job, *audit, chooser_.sized(job, worker, audit->band()).rows.last);
      return;
    }
    if (const auto band = chooser_.choose(job, worker)) {
      const bool holds_nothing = worker.leases.empty() && worker.revoked.empty();
      if (holds_nothing || !job.is_suspect(*band)) {
        ledger_.grant(worker, job, *job.pass_of(*band), *band, context_.leases.new_id());
      }
      return;
    }
  }
}

bool Dispatcher::holds_suspect(const Worker& worker) const {
  return std::any_of(worker.leases.begin(), worker.leases.end(), [&](LeaseId id) {
    const Lease& lease = *context_.leases.find(id);
    return context_.jobs.at(lease.job).is_suspect(lease.band);
  });
}

}  // namespace bandsaw::coordinator
