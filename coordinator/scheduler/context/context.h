#pragma once

// State that the parts of the scheduler share: jobs, workers, leases, clock, the durable facts
// about workers, and the step that is being written. A step is what one input leads to: records for
// the journal and actions for the engine. The durable state is what the journal's records rebuild
// after a restart.

#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scheduler/api/messages.h"
#include "coordinator/scheduler/api/options.h"
#include "coordinator/scheduler/context/job_table.h"
#include "coordinator/scheduler/context/leases.h"
#include "coordinator/scheduler/context/quarantine_list.h"
#include "coordinator/scheduler/context/scheduler_clock.h"
#include "coordinator/scheduler/context/sequence_table.h"
#include "coordinator/scheduler/context/workers.h"

namespace bandsaw::coordinator {

class Context {
 public:
  explicit Context(SchedulerOptions scheduler_options);

  /// Changes the durable state by a record, new or replayed. The durable state changes in no other
  /// way.
  void apply(const Record& record);

  /// Applies a new record and adds it to the step.
  template <class R>
  void emit(R record) {
    apply(record);
    step_.records.emplace_back(std::in_place_type<R>, std::move(record));
  }
  /// Adds an action to the step. The variant is constructed in place, because g++ 12 warns about
  /// the alternatives that a moved variant does not hold.
  template <class A>
  void act(A action) {
    step_.actions.emplace_back(std::in_place_type<A>, std::move(action));
  }
  /// Sets the answer to the request of this step.
  void answer(absl::Status status) { step_.status = std::move(status); }
  /// Sets the job id that the answer to the request of this step contains.
  void answer_job(JobId id) { step_.job = id; }
  /// Collects a lease that this step revokes.
  void revoke(SessionId session, LeaseId lease) { revoked_[session].push_back(lease); }
  /// Adds one Revoke action for each session with collected leases.
  void flush_revocations();
  /// Returns the step, and begins an empty one.
  Step take_step() { return std::exchange(step_, Step{}); }
  bool step_is_empty() const {
    return revoked_.empty() && step_.records.empty() && step_.actions.empty();
  }

  /// Returns true if the worker has sent nothing for two heartbeat intervals.
  bool is_silent(const Worker& worker) const;
  /// Returns the worker process and machine that a result comes from. After a restart only the
  /// process may be known.
  Reporter reporter_of(const input::BandStored& in) const;
  Reporter reporter_of(WorkerProcessId process) const;
  /// Returns true if this worker process joined as a browser, in any epoch.
  bool is_browser(const std::string& instance) const;
  /// Notes the time if a native worker (one that is no browser) is connected and may get leases
  /// (Worker::eligible). MUST be called at least once per heartbeat interval.
  void note_natives();
  /// Returns true if no native worker that may get leases has been connected for kNativesAway_s.
  /// Only then do browsers compare each other's pixels.
  bool only_browsers() const;
  /// Returns the displayed name of the machine that returned a result.
  std::string name_of(const Reporter& reporter) const;

  const SchedulerOptions options;
  SchedulerClock clock;
  JobTable jobs;
  SequenceTable sequences;
  Workers workers;
  AvailableWorkers available;
  Leases leases;
  QuarantineList quarantine;
  /// Journalled: worker processes (instances) that joined and have not left.
  std::set<std::string> joined;
  /// Journalled: the browsers, connected or not, that may have rendered bands of active jobs. If
  /// there are more than kMaxBrowsers, some are forgotten. When a band of a forgotten browser is
  /// read back from disk, it is audited like a band of a native worker.
  std::map<WorkerProcessId, std::string> browsers;

 private:
  /// Bounds the memory.
  static constexpr std::size_t kMaxBrowsers = 16'384;
  /// Long enough for the restart of a native worker or of the coordinator.
  static constexpr double kNativesAway_s = 60;

  Reporter absent(WorkerProcessId process) const;
  void forget_browsers();
  void apply(const record::JobAdded& r);
  void apply(const record::PassPlanned& r);
  void apply(const record::TilesPlanned& r);
  void apply(const record::SamplesFixed& r);
  void apply(const record::StateChanged& r);
  void apply(const record::PriorityChanged& r);
  void apply(const record::HoldChanged& r);
  void apply(const record::TimeSpent& r);
  void apply(const record::JobSummary& r);
  void apply(const record::ErrorMeasured& r);
  void apply(const record::ShareCounted& r);
  void apply(const record::FailureLog& r);
  void apply(const record::JobForgotten& r);
  void apply(const record::WorkerJoined& r);
  void apply(const record::WorkerLeft& r);
  void apply(const record::BandAudited& r);
  void apply(const record::BandLost& r);
  void apply(const record::RowDisputed& r);
  void apply(const record::ErrorForgotten& r);
  void apply(const record::WorkerQuarantined& r);
  void apply(const record::QuarantineLifted& r);
  void apply(const record::SequenceAdded& r);
  void apply(const record::FrameWaits& r);

  Time native_seen_at_ = 0;  ///< timeout clock: time that note_natives() noted last
  Step step_;
  /// Leases to revoke, by session of their worker.
  std::map<SessionId, std::vector<LeaseId>> revoked_;
};

}  // namespace bandsaw::coordinator
