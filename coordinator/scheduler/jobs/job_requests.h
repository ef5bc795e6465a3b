#pragma once

// Requests of users about jobs. A request that cannot be granted sets the status of the step.

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"

namespace bandsaw::coordinator {

class JobRequests {
 public:
  JobRequests(Context& context, LeaseLedger& ledger, PassPlanner& planner, JobLifecycle& lifecycle)
      : context_(context), ledger_(ledger), planner_(planner), lifecycle_(lifecycle) {}

  /// ALREADY_EXISTS: the request id is of a job with another spec. INVALID_ARGUMENT: the stop rule,
  /// image size or priority is out of range. RESOURCE_EXHAUSTED: too many jobs. A request id that
  /// is known with the same spec is answered with its job.
  void submit(const input::Submit& in);
  /// The requests below: NOT_FOUND: no such job. FAILED_PRECONDITION: it is final, except Cancel,
  /// which has no effect then.
  void cancel(const input::Cancel& in);
  /// FAILED_PRECONDITION also if the job is finishing.
  void pause(const input::Pause& in);
  void resume(const input::Resume& in);
  /// INVALID_ARGUMENT: out of range.
  void set_priority(const input::SetPriority& in);
  /// Skips frame jobs of a known sequence, which are forgotten with it.
  void forget(const input::Forget& in);

  // Used for sequences as well (sequences.h).
  static absl::Status check_priority(std::int32_t priority);
  /// Returns OK if `more` further jobs with this stop rule, image size and priority can be taken,
  /// otherwise the reason. RESOURCE_EXHAUSTED: too many jobs. INVALID_ARGUMENT: out of range.
  absl::Status refusal(const StopRule& stop, const RenderSettings& settings, std::int32_t priority,
                       std::size_t more) const;
  /// Adds a job and plans its first passes. REQUIRES: it was not refused.
  JobId add(const JobSpec& spec, std::int32_t priority);
  /// Pauses a job for a user, and continues it. REQUIRES: the job is running or paused.
  void hold(Job& job);
  void release(Job& job);

 private:
  Job* find_active(JobId id);

  Context& context_;
  LeaseLedger& ledger_;
  PassPlanner& planner_;
  JobLifecycle& lifecycle_;
};

}  // namespace bandsaw::coordinator
