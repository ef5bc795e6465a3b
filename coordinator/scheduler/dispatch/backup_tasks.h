#pragma once

// Shares the work at the end of a job, when no rows are free and some workers are idle while others
// are late (stragglers). A lease that its worker has not begun is moved to an idle worker
// ("stolen"). For the rows of a lease that is being rendered, idle workers get backup tasks
// (speculative execution; Dean & Ghemawat 2004, "MapReduce", section 3.6). If one helper would need
// too long, the rows are divided among several. The first result of a row counts, and ends the
// other leases of the row.

#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/band_chooser.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"

namespace bandsaw::coordinator {

class BackupTasks {
 public:
  BackupTasks(Context& context, LeaseLedger& ledger, const Eligibility& eligibility,
              const BandChooser& chooser, AuditLeases& audits)
      : context_(context),
        ledger_(ledger),
        eligibility_(eligibility),
        chooser_(chooser),
        audits_(audits) {}

  /// Gives work of late workers to idle ones. Returns true if some idle worker got work. Each such
  /// call leaves fewer idle workers, so share() can be called until it returns false. If rows of a
  /// job become free meanwhile, share() returns true at once, so that they can be leased first.
  bool share();

 private:
  /// A lease, and when it is expected to be done.
  struct Straggler {
    LeaseId lease = 0;
    double begins_in_s = 0;     ///< time until its worker has rendered the leases before it
    double done_in_s = 0;       ///< time until its worker has rendered it as well
    bool has_no_backup = true;  ///< it has no backup task, and is not one
  };

  std::vector<Worker*> idle_workers();
  std::vector<Straggler> stragglers() const;
  double remaining(const Lease& lease) const;
  std::vector<Worker*> helpers(const Job& job, const Lease& lease,
                               const std::vector<Worker*>& idle) const;
  bool steal(const Straggler& late, std::vector<Worker*>& idle);
  bool back_up(const Straggler& late, std::vector<Worker*>& idle);
  bool move_audit(const Straggler& late, std::vector<Worker*>& idle);
  RowRange rows_without_backup(const Job& job, const Lease& lease) const;

  Context& context_;
  LeaseLedger& ledger_;
  const Eligibility& eligibility_;
  const BandChooser& chooser_;
  AuditLeases& audits_;
  Time next_scan_at_ = 0;  ///< wall clock; until then share() does nothing
};

}  // namespace bandsaw::coordinator
