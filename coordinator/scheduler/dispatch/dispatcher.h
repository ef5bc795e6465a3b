#pragma once

// Gives work to the workers. A lease assigns a band (a range of rows and samples of a job) to a
// worker. The worker that holds the fewest leases is served first. It gets a band of the first job
// that has one for it. Jobs of higher priority come first, and among jobs of equal priority the
// older ones. When nothing is free, workers get backup tasks: second leases of late bands.

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/backup_tasks.h"
#include "coordinator/scheduler/dispatch/band_chooser.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/dispatch/frame_chooser.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"

namespace bandsaw::coordinator {

class Dispatcher {
 public:
  Dispatcher(Context& context, LeaseLedger& ledger, const Eligibility& eligibility,
             const BandChooser& chooser, AuditLeases& audits, PassPlanner& planner)
      : context_(context),
        ledger_(ledger),
        eligibility_(eligibility),
        chooser_(chooser),
        audits_(audits),
        planner_(planner),
        backups_(context, ledger, eligibility, chooser, audits),
        frames_(context) {}

  /// Grants leases until no worker can be given more.
  void assign();

 private:
  /// Gives leases of free bands (bands without a lease) to all workers that can take more.
  void lease_free();
  /// Gives the worker one lease, of the first job by rank that has a band for it.
  void lease_to(Worker& worker);
  /// Gives the worker one lease of the job. Returns false if it gets none.
  bool offer(Worker& worker, Job& job);
  /// Gives the worker one lease of a frame of the sequence. Returns false if it gets none.
  bool offer_frames(Worker& worker, const Sequence& sequence);
  /// Returns true if the worker has a lease of a suspect band (a band at which a worker was lost).
  bool holds_suspect(const Worker& worker) const;

  Context& context_;
  LeaseLedger& ledger_;
  const Eligibility& eligibility_;
  const BandChooser& chooser_;
  AuditLeases& audits_;
  PassPlanner& planner_;
  BackupTasks backups_;
  FrameChooser frames_;
};

}  // namespace bandsaw::coordinator
