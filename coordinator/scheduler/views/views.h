#pragma once

// Builds the views of jobs and workers that users see, and explains why a job is not done yet.

#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/liveness/sessions.h"

namespace bandsaw::coordinator {

class Views {
 public:
  Views(const Context& context, const Eligibility& eligibility, const AuditLeases& audits,
        const ReconnectBarrier& barrier, const Sessions& sessions)
      : context_(context),
        eligibility_(eligibility),
        audits_(audits),
        barrier_(barrier),
        sessions_(sessions) {}

  /// Returns how a job or sequence is shown to users; std::nullopt: there is none.
  std::optional<JobView> job(JobId id, Time now) const;
  /// Returns the jobs and sequences of the page, sorted by id; frames of sequences are left out.
  std::vector<JobView> jobs(Time now, const JobPage& page = {}) const;
  /// Returns the frames of a sequence whose FrameView::changed is greater than `after`, or all
  /// frames if `after` is 0; std::nullopt: no such sequence.
  std::optional<std::vector<FrameView>> frames(JobId id, std::uint64_t after) const;
  /// Returns all jobs and sequences with the packages and files that must be kept for them.
  std::vector<KeptJob> kept() const;
  std::vector<WorkerView> workers(Time now) const;  ///< sorted by name
  /// Returns why a job is not done yet, in sentences, the most important first; empty: there is no
  /// such job.
  std::vector<std::string> why(JobId id, Time now) const;

 private:
  /// Returns how the job is shown to users.
  JobView view(const Job& job, Time now) const;
  /// Returns the reason why no worker may render the job.
  std::string nobody_reason(const Job& job) const;
  /// Returns why an idle worker may not render the first job that has bands to give. Empty if
  /// there is no such job, if the worker may render one of these jobs, or if it is not idle.
  std::string idle_reason(const Worker& worker) const;
  /// Returns the reason why the worker may not render the job.
  std::string refusal(const Worker& worker, const Job& job) const;
  /// Returns machines that are under quarantine and have not connected since the coordinator
  /// started.
  std::vector<WorkerView> absent_quarantined() const;
  /// Returns why a running job without leases waits. If no reason is known, or for any other job,
  /// returns Job::notice, the last event that users should know of, which may be empty.
  std::string waiting_reason(const Job& job) const;
  std::vector<std::string> why_of_sequence(const Sequence& sequence, Time now) const;
  std::vector<std::string> why_of_state(const Job& job, Time now) const;
  std::string audit_reason(const Job& job) const;
  std::string busy_with_others(const Job& job) const;
  /// Returns a sentence for each worker that renders the job.
  std::vector<std::string> working_on(const Job& job) const;
  /// Returns a sentence for each worker that does not render the job, if a reason is known.
  std::vector<std::string> not_working_on(const Job& job) const;

  const Context& context_;
  const Eligibility& eligibility_;
  const AuditLeases& audits_;
  const ReconnectBarrier& barrier_;
  const Sessions& sessions_;
};

}  // namespace bandsaw::coordinator
