#pragma once

// The course of a job from its first pass (range of samples of the whole image) to its end: error
// checkpoints, completion, failure, and pauses because of a full disk. An error checkpoint is a
// number of samples at which the error of the image is compared with the target of the stop rule.

#include <cstdint>
#include <string>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"

namespace bandsaw::coordinator {

class JobLifecycle {
 public:
  JobLifecycle(Context& context, LeaseLedger& ledger, PassPlanner& planner,
               const AuditLeases& audits)
      : context_(context), ledger_(ledger), planner_(planner), audits_(audits) {}

  /// Evaluates a pending error checkpoint or the time limit of a running job. Requests its image
  /// once all passes are complete and it need not wait for an audit (a second rendering of stored
  /// rows, which is compared with the first). MUST be called after each change of the stored rows
  /// or of the audits.
  void advance(Job& job);
  /// Notes the error of the image, which was measured after a pass. Evaluates the error if the
  /// samples of the image are those of a checkpoint.
  void pass_merged(const input::PassMerged& in);
  /// The image is on disk: the job is done.
  void result_written(const input::ResultWritten& in);
  /// Makes the job final: revokes its leases, journals its summary, drops its bands.
  void end(Job& job, JobState state, const std::string& reason);

  /// Pauses a job because its data cannot be written.
  void storage_failed(const input::StorageFailed& in);
  /// Resumes the jobs that a failed disk has paused.
  void storage_back();
  /// Makes a paused job run again.
  void resume(Job& job);
  /// Revokes the leases of jobs that a user paused at least a second ago. Keeps the leases whose
  /// bands are rendered and only have to be uploaded.
  void revoke_from_held_jobs();
  /// Writes the elapsed time to the journal at intervals. A crash loses at most one second or one
  /// fiftieth of the time, whichever is longer. Even a long job has only a few hundred such
  /// records.
  void note_time(const Job& job);

 private:
  void note_error(const Job& job, std::uint64_t samples, const ErrorEstimate& error);
  void evaluate_checkpoint(Job& job, const input::PassMerged& merged);
  /// Returns what is kept of the job when it is final: its time, its samples, its error and so on.
  record::JobSummary summary(const Job& job) const;

  Context& context_;
  LeaseLedger& ledger_;
  PassPlanner& planner_;
  const AuditLeases& audits_;
};

}  // namespace bandsaw::coordinator
