// A backup task is a second lease of the rows of a late lease. share() goes through the leases of
// running jobs, and begins with the one that is expected to end last. A lease that is for an audit
// (a stored band is rendered again, to compare) is moved to an idle worker. A lease that its worker
// has not begun is stolen: it is ended, and its rows are leased again. For the rows of any other
// lease, idle workers get backup tasks. Each of these is done only if it saves enough time.

#include "coordinator/scheduler/dispatch/backup_tasks.h"

#include <algorithm>

#include "coordinator/scheduler/dispatch/work_rate.h"

namespace bandsaw::coordinator {
namespace {

/// Time that it takes to hand work over, in addition to rendering it.
constexpr double kTransfer_s = 0.03;
/// Fractions of the time that the original lease still needs. Backup tasks are granted only if they
/// are expected to take less than the fraction kMaxBackupTime. Idle workers are added until the
/// backup tasks need at most the fraction kTargetBackupTime.
constexpr double kMaxBackupTime = 0.75;
constexpr double kTargetBackupTime = 0.5;
/// After a scan that found nothing, the next one waits this long per active lease. This bounds the
/// CPU time of scans on large farms.
constexpr double kScanPause_s = 2e-5;
/// The remaining time of a lease is assumed to be at least this fraction of its expected whole
/// time.
constexpr double kMinRemaining = 0.25;

RowRange common_rows(const RowRange& a, const RowRange& b) {
  return {std::max(a.first, b.first), std::min(a.last, b.last)};
}

}  // namespace

bool BackupTasks::share() {
  std::vector<Worker*> idle = idle_workers();
  const auto& leases = context_.leases;
  if (idle.empty() || leases.all().empty() || context_.clock.wall() < next_scan_at_) {
    return false;
  }
  bool any = false;
  for (const Straggler& late : stragglers()) {
    if (idle.empty() || late.done_in_s < 2 * kTransfer_s) {
      break;
    }
    const Lease* lease = leases.find(late.lease);
    if (lease == nullptr) {
      continue;  // the lease ended in an earlier step of this loop
    }
    const Job& job = context_.jobs.at(lease->job);
    const bool queued = late.has_no_backup && late.begins_in_s > kTransfer_s;
    any = (lease->audit ? move_audit(late, idle)
           : queued     ? steal(late, idle)
                        : back_up(late, idle)) ||
          any;
    if (any && job.any_free()) {
      return true;
    }
  }
  if (!any) {
    next_scan_at_ = context_.clock.wall() + kScanPause_s * static_cast<double>(leases.all().size());
  }
  return any;
}

/// Returns the available workers without leases.
std::vector<Worker*> BackupTasks::idle_workers() {
  const AvailableWorkers& available = context_.available;
  std::vector<Worker*> idle;
  for (auto place = available.first_after(std::nullopt); place && place->first == 0;
       place = available.first_after(place)) {
    idle.push_back(context_.workers.by_id(place->second));
  }
  return idle;
}

/// Returns all leases of running jobs. The lease that is expected to end last comes first.
std::vector<BackupTasks::Straggler> BackupTasks::stragglers() const {
  std::vector<Straggler> late;
  for (const auto& [id, lease] : context_.leases.all()) {
    const Job& job = context_.jobs.at(lease.job);
    if (job.state != JobState::kRunning) {
      continue;
    }
    Straggler one{.lease = id};
    const auto is_its_backup = [this, &id = id](LeaseId backup) {
      return context_.leases.find(backup)->backup_of == id;
    };
    one.has_no_backup =
        lease.backup_of == 0 && std::none_of(job.backups.begin(), job.backups.end(), is_its_backup);
    for (const LeaseId ahead : context_.workers.by_id(lease.worker)->leases) {
      if (ahead == id) {
        break;
      }
      one.begins_in_s += remaining(*context_.leases.find(ahead));
    }
    one.done_in_s = one.begins_in_s + remaining(lease);
    late.push_back(one);
  }
  std::sort(late.begin(), late.end(), [](const Straggler& a, const Straggler& b) {
    return a.done_in_s != b.done_in_s ? a.done_in_s > b.done_in_s : a.lease < b.lease;
  });
  return late;
}

/// Returns the remaining render time of a lease in seconds. The whole render time is extrapolated
/// from the rows that are reported done, or else predicted from the cost map. A lease that is
/// overdue by t seconds is assumed to need another t seconds.
double BackupTasks::remaining(const Lease& lease) const {
  const Job& job = context_.jobs.at(lease.job);
  const Worker& worker = *context_.workers.by_id(lease.worker);
  double takes = job.cost_of(lease.band) / work_rate(worker, job);
  if (worker.leases.front() != lease.id) {
    return takes;
  }
  if (lease.rows_done > 0 && lease.progress_at > lease.begun_at) {
    const RowRange done{lease.band.rows.first,
                        lease.band.rows.first + std::min(lease.rows_done, lease.band.rows.count())};
    takes = (lease.progress_at - lease.begun_at) * job.cost_of(lease.band) /
            job.cost_of({lease.band.samples, done});
  }
  const double passed = context_.clock.wall() - lease.begun_at;
  return std::max({takes - passed, passed - takes, takes * kMinRemaining});
}

/// Returns the idle workers that may render the lease's band, the fastest first.
std::vector<Worker*> BackupTasks::helpers(const Job& job, const Lease& lease,
                                          const std::vector<Worker*>& idle) const {
  std::vector<Worker*> able;
  for (Worker* worker : idle) {
    const bool may =
        lease.audit ? eligibility_.may_audit(*worker, job) : eligibility_.may_render(*worker, job);
    if (worker->id != lease.worker && may &&
        !eligibility_.left_to_others(job, *worker, lease.band)) {
      able.push_back(worker);
    }
  }
  std::sort(able.begin(), able.end(), [&](const Worker* a, const Worker* b) {
    const double rate_a = work_rate(*a, job);
    const double rate_b = work_rate(*b, job);
    return rate_a != rate_b ? rate_a > rate_b : a->id < b->id;
  });
  return able;
}

/// Ends a lease that is not begun, so that its rows become free, and gives the fastest helper a
/// band of free rows. Does this only if the helper would finish a first band of the lease's rows
/// before the present worker would finish the lease.
bool BackupTasks::steal(const Straggler& late, std::vector<Worker*>& idle) {
  const Lease lease = *context_.leases.find(late.lease);
  Job& job = context_.jobs.at(lease.job);
  const std::vector<Worker*> able = helpers(job, lease, idle);
  if (able.empty()) {
    return false;
  }
  Worker& thief = *able.front();
  const Band first = chooser_.sized(job, thief, lease.band);
  if (job.cost_of(first) / work_rate(thief, job) + kTransfer_s >= late.done_in_s) {
    return false;
  }
  Worker& from = *context_.workers.by_id(lease.worker);
  context_.act(action::Revoke{*from.session, {lease.id}});
  from.revoked.insert(lease.id);
  context_.act(action::LogReassignment{job.id, lease.band, from.name, thief.name, /*begun=*/false});
  ledger_.end(lease.id, LeaseLedger::Revoke::kNo);
  std::erase(idle, &thief);
  const auto band = chooser_.choose_free(job, thief);
  if (!band) {
    return false;
  }
  ledger_.grant(thief, job, *job.pass_of(*band), *band, context_.leases.new_id());
  return true;
}

/// Moves an audit, begun or not, if the idle workers together would finish it much sooner. The
/// fastest of them gets a part of the audit, and the rest of the audit waits for the others. Each
/// machine gets an audit at most once, so that the audit is not moved indefinitely.
bool BackupTasks::move_audit(const Straggler& late, std::vector<Worker*>& idle) {
  const Lease lease = *context_.leases.find(late.lease);
  Job& job = context_.jobs.at(lease.job);
  Audit& audit = *job.audit_under(lease.id);
  std::vector<Worker*> able = helpers(job, lease, idle);
  std::erase_if(able, [&](const Worker* worker) {
    return audit.given.contains(worker->machine()) || !audits_.may_render(*worker, job, audit);
  });
  double together = 0;
  for (const Worker* worker : able) {
    together += work_rate(*worker, job);
  }
  if (job.cost_of(lease.band) >= (late.done_in_s * kMaxBackupTime - kTransfer_s) * together) {
    return false;
  }
  Worker& first = *able.front();
  const std::string& from = context_.workers.by_id(lease.worker)->name;
  context_.act(action::LogReassignment{job.id, lease.band, from, first.name, /*begun=*/false});
  ledger_.end(lease.id, LeaseLedger::Revoke::kYes);
  audits_.grant(first, job, audit, chooser_.sized(job, first, audit.band()).rows.last);
  std::erase(idle, &first);
  return true;
}

/// Grants the fastest helpers backup tasks for the rows of a lease that is being rendered. The rows
/// are divided in proportion to the helpers' work rates. Returns false if no rows or no helpers are
/// left, if the backup tasks would take too long (kMaxBackupTime), or if the band may crash
/// workers.
bool BackupTasks::back_up(const Straggler& late, std::vector<Worker*>& idle) {
  const Lease lease = *context_.leases.find(late.lease);
  Job& job = context_.jobs.at(lease.job);
  if (job.has_conclusive_crash(lease.band)) {
    return false;  // the band may crash workers, so only one renders it
  }
  RowRange rows = rows_without_backup(job, lease);
  std::vector<Worker*> able = helpers(job, lease, idle);
  able.resize(std::min<std::size_t>(able.size(), rows.count()));
  const double all = job.cost_of({lease.band.samples, rows});
  double together = 0;
  std::size_t count = 0;
  while (count < able.size() &&
         all > (late.done_in_s * kTargetBackupTime - kTransfer_s) * together) {
    together += work_rate(*able[count++], job);
  }
  if (count == 0 || all > (late.done_in_s * kMaxBackupTime - kTransfer_s) * together) {
    return false;
  }
  Pass& pass = *job.pass_of(lease.band);
  // The number of pixel samples in one row of the band. Job::cost_of() multiplies CostMap::of() by
  // this number.
  const double row_samples =
      static_cast<double>(lease.band.samples.samples()) * job.spec.settings.width;
  const LeaseId original = lease.backup_of == 0 ? lease.id : lease.backup_of;
  for (std::size_t i = 0; i < count && rows.count() > 0; ++i) {
    Worker& helper = *able[i];
    const double part = all * work_rate(helper, job) / together;
    Band band{lease.band.samples, rows};
    if (i + 1 < count) {
      band.rows.last =
          rows.first + job.cost.fitting(rows, part / row_samples, pass.tile_row_shares);
    }
    rows.first = band.rows.last;
    const std::string& from = context_.workers.by_id(lease.worker)->name;
    context_.act(action::LogReassignment{job.id, band, from, helper.name, /*begun=*/true});
    const LeaseId id = context_.leases.new_id();
    job.backups.insert(id);
    ++job.backups_granted;
    ledger_.add(
        helper, job, pass,
        {.id = id, .job = job.id, .worker = helper.id, .band = band, .backup_of = original});
    std::erase(idle, &helper);
  }
  return true;
}

/// Returns the first consecutive rows of a lease that are wanted (no result is stored) and have no
/// backup task; empty: there are none. If the lease is a backup task itself, only backup tasks of
/// the same original that were granted later are considered.
RowRange BackupTasks::rows_without_backup(const Job& job, const Lease& lease) const {
  for (RowRange rows : job.pass_of(lease.band)->coverage.wanted(lease.band)) {
    bool again = true;
    while (again && rows.first < rows.last) {
      again = false;
      for (const LeaseId id : job.backups) {
        const Lease& backup = *context_.leases.find(id);
        const RowRange both = common_rows(backup.band.rows, rows);
        const bool later = lease.backup_of == 0
                               ? backup.backup_of == lease.id
                               : backup.backup_of == lease.backup_of && backup.id > lease.id;
        if (!later || both.first >= both.last) {
          continue;
        }
        // Cuts off the rows of this backup task, at the front (then starts again) or at the end.
        again = both.first == rows.first;
        (again ? rows.first : rows.last) = again ? both.last : both.first;
        break;
      }
    }
    if (rows.first < rows.last) {
      return rows;
    }
  }
  return {};
}

}  // namespace bandsaw::coordinator
