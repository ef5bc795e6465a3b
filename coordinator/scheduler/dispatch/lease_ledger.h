#pragma once

// Grants and ends leases, and keeps the coverage, the job and the worker of a lease consistent with
// it. All leases begin and end here.

#include <cstddef>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class LeaseLedger {
 public:
  explicit LeaseLedger(Context& context) : context_(context) {}

  enum class Revoke { kNo, kYes };

  /// Gives the band's rows to the worker. Ends leases that thereby lose all of their rows.
  void grant(Worker& worker, Job& job, Pass& pass, const Band& band, LeaseId id);
  /// Adds a lease that owns no rows: of a backup task or an audit.
  void add(Worker& worker, Job& job, const Pass& pass, Lease lease);
  /// Frees the lease's rows, or passes them on to its backup tasks. kYes: also revokes the lease at
  /// its worker.
  void end(LeaseId id, Revoke revoke);
  /// Ends a lease whose result has arrived. Revokes it if it was named in the worker's Hello: the
  /// reply to that may reach the worker after it has dropped the band.
  void end_rendered(LeaseId id);
  /// Calls end_rendered() for the worker's lease of exactly this band, if it has one.
  void end_rendered(const Worker& worker, JobId job, const Band& band);
  /// Ends those of the leases that still exist.
  void end_all(const std::vector<LeaseId>& leases, Revoke revoke);
  /// Revokes those of the leases that own nothing any more.
  void end_overtaken(const std::vector<LeaseId>& leases);
  /// Revokes backup tasks whose rows are all stored.
  void end_useless_backups(Job& job);
  /// Notes progress on the worker's lease number `from`. A worker renders its leases in order, so
  /// the later ones are waiting for this one; the earlier ones have made no progress.
  void note_progress(const Worker& worker, std::size_t from);

 private:
  void promote_backups(Job& job, LeaseId ended);

  Context& context_;
};

}  // namespace bandsaw::coordinator
