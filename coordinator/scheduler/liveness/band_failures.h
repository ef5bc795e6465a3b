#pragma once

// Handles bands (ranges of rows and samples, leased to a worker) that a worker could not render, or
// on which it makes no progress. Fails a job if one of its bands failed too often, or if no
// connected worker may render the job any more.

#include <string>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"

namespace bandsaw::coordinator {

class BandFailures {
 public:
  BandFailures(Context& context, LeaseLedger& ledger, const Eligibility& eligibility,
               AuditLeases& audits, const ReconnectBarrier& barrier, JobLifecycle& lifecycle)
      : context_(context),
        ledger_(ledger),
        eligibility_(eligibility),
        audits_(audits),
        barrier_(barrier),
        lifecycle_(lifecycle) {}

  /// A worker reports that it could not render a band.
  void band_failed(const input::BandFailed& in);
  /// Ends each lease that made no progress for the progress timeout. The timeout is longer while a
  /// finished band is being uploaded. The end counts as a failure of the worker. Exception: if the
  /// lease is for an audit (a second rendering of stored rows, to compare), another machine gets
  /// the audit, and no failure is counted.
  void check_progress();
  /// Fails a job that no connected worker may render any more, once workers have had time to
  /// reconnect. If no connected native worker (one that is no browser) has failed too many of the
  /// job's bands, the job is not failed but waits for a worker.
  void check_renderable(Job& job);

 private:
  /// Notes a failure, and fails the job if the band failed too often.
  void add(Job& job, Worker& worker, const Band& band, const std::string& reason);

  Context& context_;
  LeaseLedger& ledger_;
  const Eligibility& eligibility_;
  AuditLeases& audits_;
  const ReconnectBarrier& barrier_;
  JobLifecycle& lifecycle_;
};

}  // namespace bandsaw::coordinator
