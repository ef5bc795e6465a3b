#pragma once

// Leases of audits. An audit compares a stored band (a range of rows and samples) with the result
// of a second machine (model/audit.h); this part decides which machine renders it again. An audit
// is disputed if machines have returned different results and none is known to be right.

#include <cstdint>
#include <string>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"

namespace bandsaw::coordinator {

class AuditLeases {
 public:
  AuditLeases(Context& context, LeaseLedger& ledger, const Eligibility& eligibility,
              const ReconnectBarrier& barrier)
      : context_(context), ledger_(ledger), eligibility_(eligibility), barrier_(barrier) {}

  /// Returns true if the worker may render the audit's band. If the worker's machine has returned a
  /// result for the band already, the worker may not, with one exception: if the audit is disputed
  /// and no other machine is left, it may render the band once more. Native workers (no browsers)
  /// audit all bands. Browsers audit only bands of other browsers, and only if no native worker is
  /// there (Context::only_browsers).
  bool may_render(const Worker& worker, const Job& job, const Audit& audit) const;
  /// Returns the first audit that has no lease and that the worker may render; nullptr: none.
  Audit* next_for(const Worker& worker, Job& job) const;
  /// Leases the rows of the audit before `end_row` to the worker, and makes a new audit of the
  /// remaining rows. If the audit is disputed, or if the job has Job::kMaxAudits audits already,
  /// the audit is not divided but leased as a whole. Invalidates `audit`.
  void grant(Worker& worker, Job& job, Audit& audit, std::uint32_t end_row);
  /// Ends an audit lease that the worker could not render. This does not count as a failure of the
  /// band: another machine is chosen for the audit, if there is one.
  void give_up(const Lease& lease, const Worker& worker, const std::string& reason);
  /// Returns true if an audit may still find that stored rows are wrong. Then the job must not end,
  /// and its error must not be compared with its target. If no machine can render an audit, the
  /// audit blocks only if it is doubtful: it is disputed, and the stored rows may be wrong.
  bool block(const Job& job) const;

 private:
  Context& context_;
  LeaseLedger& ledger_;
  const Eligibility& eligibility_;
  const ReconnectBarrier& barrier_;
};

}  // namespace bandsaw::coordinator
