// assign() gives free rows to workers, one lease for each worker in turn, and then backup tasks
// (second leases of late bands), until no worker can take more. A worker can take as many leases as
// it has credits.

#include "coordinator/scheduler/dispatch/dispatcher.h"

#include <algorithm>
#include <limits>

namespace bandsaw::coordinator {

void Dispatcher::assign() {
  lease_free();
  while (backups_.share()) {
    lease_free();
  }
}

/// Gives each worker with a spare credit one lease. Workers are visited in ascending order of the
/// number of leases that they hold. So a worker that gets a lease and can hold one more moves back
/// in this order and is visited again.
void Dispatcher::lease_free() {
  const AvailableWorkers& available = context_.available;
  for (auto place = available.first_after(std::nullopt); place && !context_.jobs.leasable().empty();
       place = available.first_after(place)) {
    lease_to(*context_.workers.by_id(place->second));
  }
}

/// Grants the worker one lease, if there is one for it.
void Dispatcher::lease_to(Worker& worker) {
  if (holds_suspect(worker)) {  // a worker that holds a suspect band gets nothing else
    return;
  }
  const auto& leasable = context_.jobs.leasable();
  for (auto it = leasable.begin(); it != leasable.end();) {
    const JobTable::Rank rank = *it;
    Job& job = context_.jobs.at(rank.job);
    const Sequence* sequence = context_.sequences.find(job.spec.sequence);
    if (sequence == nullptr ? offer(worker, job) : offer_frames(worker, *sequence)) {
      return;
    }
    // offer_frames() has offered all frames of the sequence, so all of them are skipped.
    it = sequence == nullptr ? leasable.upper_bound(rank)
                             : leasable.upper_bound({rank.descending_priority, rank.place,
                                                     std::numeric_limits<JobId>::max()});
  }
}

/// Offers a worker the frames of a sequence, which are neighbours in the order of jobs. Returns
/// true once offer() has returned true for one of them.
bool Dispatcher::offer_frames(Worker& worker, const Sequence& sequence) {
  for (Job* job : frames_.order_for(worker, sequence)) {
    const std::size_t before = worker.leases.size();
    if (offer(worker, *job)) {
      if (worker.leases.size() > before) {
        frames_.joined(worker, *job);
      }
      return true;
    }
  }
  return false;
}

/// Grants the worker a lease of a band of the job. Returns false if the job has no band for this
/// worker. Returns true without a lease if the band is suspect (an earlier worker was lost while it
/// held the band) and the worker holds other leases. A suspect band is given only to a worker that
/// holds nothing else. So if that worker is lost as well, its crash can be attributed to the band.
bool Dispatcher::offer(Worker& worker, Job& job) {
  if (!job.any_free() && !planner_.plan_timed(job) && !job.audit_waits()) {
    context_.jobs.unmark_leasable(job);
    return false;
  }
  if (!eligibility_.may_audit(worker, job)) {
    return false;
  }
  if (Audit* audit = audits_.next_for(worker, job)) {
    audits_.grant(worker, job, *audit, chooser_.sized(job, worker, audit->band()).rows.last);
    return true;
  }
  const auto band =
      eligibility_.may_render(worker, job) ? chooser_.choose(job, worker) : std::nullopt;
  if (!band) {
    return false;
  }
  const bool holds_nothing = worker.leases.empty() && worker.revoked.empty();
  if (holds_nothing || !job.is_suspect(*band)) {
    ledger_.grant(worker, job, *job.pass_of(*band), *band, context_.leases.new_id());
  }
  return true;
}

/// Returns true if the worker has a lease of a suspect band.
bool Dispatcher::holds_suspect(const Worker& worker) const {
  return std::any_of(worker.leases.begin(), worker.leases.end(), [&](LeaseId id) {
    const Lease& lease = *context_.leases.find(id);
    return context_.jobs.at(lease.job).is_suspect(lease.band);
  });
}

}  // namespace bandsaw::coordinator
