#pragma once

// The scheduler: decides which worker renders which band, and everything else about jobs and
// workers. A band is a range of rows and samples of an image; it is leased to a worker. The
// scheduler is a pure state machine: it takes one input at a time, with the time at which it came,
// and returns records for the journal and actions for the engine. The same inputs lead to the same
// outputs. README.md describes its parts.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "coordinator/scheduler/api/job_view.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/scheduler/api/options.h"
#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/audit_leases.h"
#include "coordinator/scheduler/dispatch/band_chooser.h"
#include "coordinator/scheduler/dispatch/dispatcher.h"
#include "coordinator/scheduler/dispatch/eligibility.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/dispatch/pass_planner.h"
#include "coordinator/scheduler/jobs/job_lifecycle.h"
#include "coordinator/scheduler/jobs/job_requests.h"
#include "coordinator/scheduler/jobs/sequences.h"
#include "coordinator/scheduler/jobs/stored_bands.h"
#include "coordinator/scheduler/liveness/band_failures.h"
#include "coordinator/scheduler/liveness/crash_attribution.h"
#include "coordinator/scheduler/liveness/sessions.h"
#include "coordinator/scheduler/replay/restart.h"
#include "coordinator/scheduler/trust/quarantine.h"
#include "coordinator/scheduler/trust/result_comparison.h"
#include "coordinator/scheduler/views/views.h"

namespace bandsaw::coordinator {

class Scheduler {
 public:
  explicit Scheduler(SchedulerOptions options);
  Scheduler(const Scheduler&) = delete;
  Scheduler& operator=(const Scheduler&) = delete;

  /// Handles one input. `now` may jump or go back. A Tick MUST come at least once per heartbeat
  /// interval.
  Step step(const Input& input, Time now);

  // For a restart. Call replay for all journalled records in their order, then for all bands found
  // on disk and their damage, then `replayed` once, then step for inputs.
  void replay(const Record& record);
  void replay(const input::BandStored& band);
  /// Notes that `bytes` bytes (> 0) of a job's band log, the file of its stored bands, belong to no
  /// whole band. Users see this in `bandsaw why`.
  void replay_damage(JobId job, std::uint64_t bytes);
  /// Ends the replay. The actions of the step continue jobs that were finishing.
  Step replayed(Time now);

  /// Returns the rows of a band that the job still wants; empty: all are stored. std::nullopt: the
  /// job is final or unknown, or the band is not a part of one of its passes.
  std::optional<std::vector<RowRange>> wanted(JobId job, const Band& band) const;
  /// Returns the samples that each half tile (half of the pixels of a 16 x 16 tile) of the band
  /// takes. They differ only in adaptive jobs. If the job or its pass is unknown, each half tile
  /// takes all samples of the band.
  TileSamples tiles(JobId job, const Band& band) const;

  /// Returns the smallest list of records whose replay gives the durable state, that is, the state
  /// that survives a restart.
  std::vector<Record> snapshot() const;

  /// Returns how a job or sequence is shown to users; std::nullopt: there is none.
  std::optional<JobView> job(JobId id, Time now) const;
  /// Returns why a job is not done yet, in sentences, the most important first; empty: no such job.
  std::vector<std::string> why(JobId id, Time now) const;
  /// Returns the jobs and sequences that `page` selects, ascending by id, without the jobs of
  /// frames.
  std::vector<JobView> jobs(Time now, const JobPage& page = {}) const;
  /// Returns the frames of a sequence whose FrameView::changed is greater than `after`, or all
  /// frames if `after` is 0. They ascend by number. std::nullopt: there is no such sequence.
  std::optional<std::vector<FrameView>> frames(JobId id, std::uint64_t after) const;
  /// Returns all jobs and sequences with the packages and files that must be kept for them. If the
  /// sequence of a frame job is known, the frame job is listed in the entry of the sequence only.
  std::vector<KeptJob> kept() const { return views_.kept(); }
  std::vector<WorkerView> workers(Time now) const;  ///< sorted by name
  /// Returns true if the worker process with this instance id joined as a browser. Browsers that
  /// have left are forgotten when the last active job ends, not at a restart of the coordinator.
  bool is_browser(const std::string& instance) const;

  /// Returns a sentence about the first invariant that does not hold; std::nullopt: all hold. For
  /// tests, after every step.
  std::optional<std::string> broken_invariant() const;

 private:
  void on(const input::Submit& in) { requests_.submit(in); }
  void on(const input::SubmitSequence& in) { sequences_.submit(in); }
  void on(const input::AddFrames& in) { sequences_.add_frames(in); }
  void on(const input::RetryFrames& in) { sequences_.retry(in); }
  void on(const input::Cancel& in) {
    sequences_.owns(in.job) ? sequences_.cancel(in) : requests_.cancel(in);
  }
  void on(const input::Pause& in) {
    sequences_.owns(in.job) ? sequences_.pause(in) : requests_.pause(in);
  }
  void on(const input::Resume& in) {
    sequences_.owns(in.job) ? sequences_.resume(in) : requests_.resume(in);
  }
  void on(const input::SetPriority& in) {
    sequences_.owns(in.job) ? sequences_.set_priority(in) : requests_.set_priority(in);
  }
  void on(const input::Forget& in) {
    requests_.forget(in);
    sequences_.forget(in);
  }
  void on(const input::Hello& in) { sessions_.hello(in); }
  void on(const input::Heartbeat& in) { sessions_.heartbeat(in); }
  void on(const input::Draining& in) { sessions_.draining(in); }
  void on(const input::SessionEnded& in) { sessions_.ended(in); }
  void on(const input::BandFailed& in) { failures_.band_failed(in); }
  void on(const input::BandStored& in);
  void on(const input::BandsDamaged& in);
  void on(const input::PassMerged& in) { lifecycle_.pass_merged(in); }
  void on(const input::ResultWritten& in) { lifecycle_.result_written(in); }
  void on(const input::StorageFailed& in) { lifecycle_.storage_failed(in); }
  void on(const input::StorageBack&) { lifecycle_.storage_back(); }
  void on(const input::Quarantine& in) { quarantine_.request(in); }
  void on(const input::LiftQuarantine& in) { quarantine_.lift(in); }
  void on(const input::Tick& in);
  Step finish_step();

  // Each part uses the context and some of the parts that are declared before it.
  Context context_;
  ReconnectBarrier barrier_;
  LeaseLedger ledger_;
  Eligibility eligibility_;
  BandChooser chooser_;
  AuditLeases audits_;
  PassPlanner planner_;
  Dispatcher dispatcher_;
  JobLifecycle lifecycle_;
  JobRequests requests_;
  Sequences sequences_;
  StoredBands bands_;
  CrashAttribution crashes_;
  BandFailures failures_;
  Sessions sessions_;
  Quarantine quarantine_;
  ResultComparison comparison_;
  Views views_;
  Restart restart_;
};

}  // namespace bandsaw::coordinator
