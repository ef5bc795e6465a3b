// A lease assigns a band (a range of rows and samples) to a worker. Every change of a lease
// is recorded in three places: in its job, at its worker, and in the coverage of its pass. The
// coverage is the table of the lease that owns each row.

#include "coordinator/scheduler/dispatch/lease_ledger.h"

#include <algorithm>
#include <set>

namespace bandsaw::coordinator {

void LeaseLedger::grant(Worker& worker, Job& job, Pass& pass, const Band& band, LeaseId id) {
  const Coverage::Change change = pass.coverage.assign(band, id);
  add(worker, job, pass, {.id = id, .job = job.id, .worker = worker.id, .band = band});
  end_overtaken(change.overtaken);
  end_useless_backups(job);
  context_.jobs.mark_leasable(job);
}

void LeaseLedger::add(Worker& worker, Job& job, const Pass& pass, Lease lease) {
  const SchedulerClock& clock = context_.clock;
  lease.begun_at = clock.wall();
  lease.advanced_at = clock.timeout_clock();
  context_.leases.add(lease);
  worker.leases.push_back(lease.id);
  job.leases.insert(lease.id);
  context_.available.update(worker);
  start_clocks(job);
  const auto returned = pass.returned.find({lease.band.samples.first, lease.band.rows.first});
  const std::uint32_t attempt = returned == pass.returned.end() ? 1 : 1 + returned->second;
  context_.act(action::Lease{*worker.session, lease.id, job.id, job.spec.manifest,
                             job.spec.settings, lease.band, pass.tiles_of(lease.band), attempt,
                             lease.audit});
}

void LeaseLedger::start_clocks(Job& job) {
  const Time now = context_.clock.wall();
  if (job.state == JobState::kPaused) {
    return;  // the lease is one that a worker still held when it reconnected
  }
  if (!job.clock.runs()) {
    job.clock.start(now);
    job.throughput.start(now);
  }
  if (Sequence* sequence = context_.sequences.find(job.spec.sequence);
      sequence != nullptr && !sequence->held) {
    sequence->clock.start(now);
  }
}

void LeaseLedger::end(LeaseId id, Revoke revoke) {
  const Lease lease = *context_.leases.find(id);
  Job& job = context_.jobs.at(lease.job);
  Worker& worker = *context_.workers.by_id(lease.worker);
  if (Pass* pass = job.pass_of(lease.band); pass->coverage.holds(lease.band, id)) {
    pass->coverage.give_back(lease.band, id);
    ++pass->returned[{lease.band.samples.first, lease.band.rows.first}];
    context_.jobs.mark_leasable(job);
  }
  if (Audit* audit = lease.audit ? job.audit_under(id) : nullptr) {
    audit->lease = 0;
    context_.jobs.mark_leasable(job);
  }
  context_.leases.erase(id);
  job.leases.erase(id);
  job.backups.erase(id);
  const auto place = std::find(worker.leases.begin(), worker.leases.end(), id);
  const auto index = static_cast<std::size_t>(place - worker.leases.begin());
  worker.leases.erase(place);
  note_progress(worker, index);
  if (index == 0 && !worker.leases.empty()) {
    context_.leases.find(worker.leases.front())->begun_at = context_.clock.wall();
  }
  context_.available.update(worker);
  if (revoke == Revoke::kYes && worker.session) {
    context_.revoke(*worker.session, id);
    worker.revoked.insert(id);
  }
  if (lease.backup_of == 0) {
    promote_backups(job, id);
  }
}

void LeaseLedger::end_rendered(LeaseId id) {
  // If the lease was in the worker's Hello, the worker may have sent the result before it read the
  // reply. Then it must be told that the lease has ended (Lease::in_hello).
  end(id, context_.leases.find(id)->in_hello ? Revoke::kYes : Revoke::kNo);
}

void LeaseLedger::end_rendered(const Worker& worker, JobId job, const Band& band) {
  const auto lease = std::find_if(worker.leases.begin(), worker.leases.end(), [&](LeaseId id) {
    const Lease& one = *context_.leases.find(id);
    return one.job == job && one.band == band;
  });
  if (lease != worker.leases.end()) {
    end_rendered(*lease);
  }
}

void LeaseLedger::end_overtaken(const std::vector<LeaseId>& leases) {
  for (const LeaseId id : leases) {
    if (const Lease* lease = context_.leases.find(id)) {
      const Pass* pass = context_.jobs.at(lease->job).pass_of(lease->band);
      if (!pass->coverage.holds(lease->band, id)) {
        end(id, Revoke::kYes);
      }
    }
  }
}

void LeaseLedger::end_all(const std::vector<LeaseId>& leases, Revoke revoke) {
  for (const LeaseId id : leases) {
    // A backup task may have ended together with its original.
    if (context_.leases.find(id) != nullptr) {
      end(id, revoke);
    }
  }
}

void LeaseLedger::note_progress(const Worker& worker, std::size_t from) {
  for (std::size_t i = from; i < worker.leases.size(); ++i) {
    context_.leases.find(worker.leases[i])->advanced_at = context_.clock.timeout_clock();
  }
}

/// Called when the lease `ended` has ended. Each backup task of this lease now becomes an ordinary
/// lease, which owns the wanted (not stored) rows of its band. Exception: if the band has no wanted
/// rows, or if another lease owns some of their samples, the backup task is revoked.
void LeaseLedger::promote_backups(Job& job, LeaseId ended) {
  const std::set<LeaseId> backups = job.backups;
  for (const LeaseId id : backups) {
    Lease* lease = context_.leases.find(id);
    if (lease == nullptr || lease->backup_of != ended) {
      continue;
    }
    Pass* pass = job.pass_of(lease->band);
    if (!pass->coverage.adoptable(lease->band)) {
      end(id, Revoke::kYes);
      continue;
    }
    pass->coverage.assign(lease->band, id);
    lease->backup_of = 0;
    job.backups.erase(id);
    context_.jobs.mark_leasable(job);
  }
}

void LeaseLedger::end_useless_backups(Job& job) {
  const std::set<LeaseId> backups = job.backups;
  for (const LeaseId id : backups) {
    const Lease* lease = context_.leases.find(id);
    if (lease != nullptr && job.pass_of(lease->band)->coverage.wanted(lease->band).empty()) {
      end(id, Revoke::kYes);
    }
  }
}

}  // namespace bandsaw::coordinator
