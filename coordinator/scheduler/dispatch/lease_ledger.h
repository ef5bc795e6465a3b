#pragma once

// Grants and ends leases: all leases begin and end here. A lease is recorded in three places, which
// this class keeps consistent: in the coverage of its pass (who owns each row), in its job, and at
// its worker.

#include <cstddef>
#include <vector>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class LeaseLedger {
 public:
  explicit LeaseLedger(Context& context) : context_(context) {}

  /// Says whether the worker is told that a lease has ended (action::Revoke).
  enum class Revoke { kNo, kYes };

  /// Gives the worker a lease of this band with the id `id`. The new lease takes over the rows of
  /// the band that are not stored. A lease that has lost all of its rows in this way is ended.
  void grant(Worker& worker, Job& job, Pass& pass, const Band& band, LeaseId id);
  /// Adds a lease to the job and to the worker, but not to the coverage of the pass. Other classes
  /// call it only for leases that own no rows: backup tasks (second leases of late bands) and
  /// audits.
  void add(Worker& worker, Job& job, const Pass& pass, Lease lease);
  /// Starts the clocks that count the elapsed times of the job and of its sequence. REQUIRES: the
  /// job has a lease. Does nothing if the job is paused. A clock that runs already is unchanged,
  /// and so is the clock of a sequence that a user paused.
  void start_clocks(Job& job);
  /// Frees the lease's rows, or passes them on to its backup tasks. kYes: also revokes the lease at
  /// its worker.
  void end(LeaseId id, Revoke revoke);
  /// Ends a lease whose result has arrived. Also revokes it if the worker named it in the Hello of
  /// a reconnect: the coordinator's reply grants the lease again, and the worker may read this
  /// reply after it has sent the result and dropped the band.
  void end_rendered(LeaseId id);
  /// Calls end_rendered() for the worker's lease of exactly this band, if it has one.
  void end_rendered(const Worker& worker, JobId job, const Band& band);
  /// Ends these leases; ids of leases that have ended already are skipped.
  void end_all(const std::vector<LeaseId>& leases, Revoke revoke);
  /// Ends and revokes those of `leases` that own no row any more.
  void end_overtaken(const std::vector<LeaseId>& leases);
  /// Revokes backup tasks whose rows are all stored.
  void end_useless_backups(Job& job);
  /// Notes that the lease at index `from` of the worker made progress, which extends its timeout. A
  /// worker renders its leases in order. So the timeouts of the later leases, which wait for the
  /// lease at `from`, are extended as well. The timeouts of the earlier leases are not.
  void note_progress(const Worker& worker, std::size_t from);

 private:
  void promote_backups(Job& job, LeaseId ended);

  Context& context_;
};

}  // namespace bandsaw::coordinator
