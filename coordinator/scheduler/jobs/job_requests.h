#pragma once

// Requests of users about jobs: submit, cancel, pause, resume, priority, forget. A request that
// fails is answered with an error status (Context::answer). The comments of the functions name
// these statuses.

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"

namespace bandsaw::coordinator {

class JobRequests {
 public:
  JobRequests(Context& context, LeaseLedger& ledger, PassPlanner& planner, JobLifecycle& lifecycle)
      : context_(context), ledger_(ledger), planner_(planner), lifecycle_(lifecycle) {}

  /// Adds a job, or answers with the job that has this request id and the same spec. Fails with
  /// ALREADY_EXISTS if the request id is that of a job with another spec, with INVALID_ARGUMENT if
  /// the stop rule, image size or priority is out of range, and with RESOURCE_EXHAUSTED if there
  /// are too many jobs.
  void submit(const input::Submit& in);
  /// cancel(), pause(), resume() and set_priority() fail with NOT_FOUND if there is no such job.
  /// All of them except cancel() fail with FAILED_PRECONDITION if the job is final (done, failed or
  /// cancelled). Cancelling a final job has no effect.
  void cancel(const input::Cancel& in);
  /// Also fails with FAILED_PRECONDITION if the job is finishing: all of it is rendered.
  void pause(const input::Pause& in);
  void resume(const input::Resume& in);
  /// Also fails with INVALID_ARGUMENT if the priority is out of range.
  void set_priority(const input::SetPriority& in);
  /// Removes final jobs. Skips the frame jobs of a sequence that is known: they are removed
  /// together with the sequence.
  void forget(const input::Forget& in);

  // sequences.h uses the following functions for sequences as well.
  /// Returns INVALID_ARGUMENT if the priority is not in [-kMaxPriority, kMaxPriority], else OK.
  static absl::Status check_priority(std::int32_t priority);
  /// Returns OK if `more` further jobs with this stop rule, image size and priority can be added.
  /// Otherwise returns the reason: RESOURCE_EXHAUSTED if there would be too many jobs,
  /// INVALID_ARGUMENT if a value is out of range.
  absl::Status refusal(const StopRule& stop, const RenderSettings& settings, std::int32_t priority,
                       std::size_t more) const;
  /// Adds a job and plans its first passes. REQUIRES: refusal() has returned OK for it.
  JobId add(const JobSpec& spec, std::int32_t priority);
  /// hold() pauses a job for a user, and release() continues it. REQUIRES: the job is running or
  /// paused.
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
