#pragma once

// One job: its specification, its state, its passes with the rows that are stored, its leases,
// audits and failures. A pass is a range of samples of the whole image; a band is a range of rows
// and samples, which one worker renders. An audit is a second render of a band, to compare. The
// timeout clock (context/scheduler_clock.h) advances at each input by the time since the last one,
// but at most by a limit. So no timeout ends only because the coordinator stood still for an hour.

#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "coordinator/scheduler/api/messages.h"
#include "coordinator/scheduler/model/audit.h"
#include "coordinator/scheduler/model/pass.h"
#include "coordinator/scheduler/model/rates.h"
#include "coordinator/scheduler/model/row_costs.h"
#include "coordinator/scheduler/model/work_clock.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {

/// The reason of a job that a user paused.
inline constexpr char kPausedByUser[] = "paused by a user; continue it with: bandsaw resume";

/// A band that a worker could not render, or on which it made no progress.
struct FailedAttempt {
  Band band;
  std::string instance;
  std::string reason;
};

/// A band that a worker held when it was lost, so the band may have crashed the worker. The
/// suspicion ends when the worker reconnects. For a row of the band, it also ends when a result of
/// the row is stored.
struct Suspicion {
  Band band;                     ///< without rows that were stored after the worker was lost
  std::uint32_t piece_rows = 0;  ///< rows of each piece in which it is retried
  std::string instance;
  std::string machine;  ///< identifies its machine (Worker::machine)
  /// The band was suspect already and was all that the worker held: this crash counts against the
  /// band.
  bool conclusive = false;
};

class Job {
 public:
  Job(JobId id, JobSpec spec, std::uint32_t pixel_version);

  /// Returns the pass that contains the band's samples. nullptr: there is none, the rows are not in
  /// the image, or the samples are not a node of the summation tree, that is, an aligned
  /// power-of-two number of blocks of 8 samples (renderlib/render/band.h).
  Pass* pass_of(const Band& band);
  const Pass* pass_of(const Band& band) const;

  /// Appends a pass; it MUST begin where the last one ends.
  void add_pass(const SampleRange& samples);
  /// Sets the number of samples of each half tile (half of the pixels of a 16 x 16 tile) in the
  /// passes that are added later.
  void plan_tiles(TilePlan plan);
  /// Makes the job end after this many samples: removes all later passes.
  void fix_samples(std::uint64_t samples);
  /// Frees everything that the process stored in any pass, so that it is rendered again. Drops the
  /// share of the process and the audits of its bands. Returns false if it had stored nothing.
  bool retract(WorkerProcessId process);
  /// Frees a band that the process stored, so that it is rendered again, and forgets that the band
  /// was audited. Frees nothing if Pass::has_stored is false.
  void remove_stored(const Band& band, WorkerProcessId process);
  /// Forgets the disputes about rows of a band that the process stored: they are decided, or the
  /// rows are lost.
  void settle_disputes(const Band& band, WorkerProcessId process);
  /// Advances the count of complete passes. Keeps the row digests of only the last
  /// kPassesWithDigests of them, and forgets the others.
  void count_complete_passes();
  /// Drops passes, plans, failures and digests of a job that becomes final.
  void drop_details();

  std::uint64_t planned_samples() const;   ///< samples per pixel of all passes
  std::uint64_t complete_samples() const;  ///< samples per pixel of the complete passes
  bool complete() const { return fixed_samples && complete_samples() >= *fixed_samples; }
  bool any_free() const;
  /// Returns true if an open audit is not leased: its band waits for a machine that renders it a
  /// second time.
  bool audit_waits() const;
  /// Returns the pixel samples of its passes that are neither leased nor stored.
  double free_samples() const;
  /// Returns the samples, counters and CPU time of all that is stored; for a final job, those of
  /// its summary.
  Totals totals() const;
  /// Returns the largest of the workers' shares in the work, at most kMaxFinalShares, in descending
  /// order.
  std::vector<WorkerShare> largest_shares() const;
  std::uint64_t pixels() const;
  /// Returns the pixel samples of the band.
  std::uint64_t samples_of(const Band& band) const;
  /// Returns the work to render the band: pixel samples, weighted with the relative costs of their
  /// rows (CostMap).
  double cost_of(const Band& band) const;
  /// Returns the largest number of samples per pixel that its stop rule allows.
  std::uint64_t max_samples() const;
  /// Returns the time in seconds since its first lease, summed over all epochs. The time in which
  /// it was paused does not count.
  double elapsed(Time now) const;
  /// Stops elapsed() at `now`, because the job is paused, and forgets the throughput.
  void stop_clock(Time now);
  /// Returns the open audit that is rendered under this lease; nullptr: none.
  Audit* audit_under(LeaseId lease);
  bool timed() const { return std::holds_alternative<StopAtTime>(spec.stop); }

  /// Returns true if a part of the band is suspect.
  bool is_suspect(const Band& band) const;
  /// Returns true if a part of the band has a conclusive crash (Suspicion).
  bool has_conclusive_crash(const Band& band) const;
  /// Ends the suspicion of rows that are now stored, since they did not crash their worker. If the
  /// stored rows lie at an end of a suspect range, the range becomes shorter. If they lie in its
  /// middle, the range is not changed.
  void clear_suspicion(const Band& stored);

  JobId id = 0;
  JobSpec spec;
  std::uint32_t pixel_version = 0;  ///< the version with which the job was begun; 0: unknown
  JobState state = JobState::kRunning;
  std::int32_t priority = 0;
  bool held = false;   ///< paused by a user
  Time held_at = 0;    ///< timeout clock: when `held` changed last
  std::string reason;  ///< why the job is in its state
  std::string notice;  ///< the last event that users should know of, shown while the job runs
  std::string damage;  ///< damage of its bands on disk, in this epoch (run of the coordinator)
  std::uint64_t damaged_bands = 0;             ///< found while the coordinator ran, in this epoch
  std::optional<std::uint64_t> fixed_samples;  ///< the job ends after this many samples per pixel
  std::vector<Pass> passes;                    ///< from sample 0 on, without gaps
  /// For an adaptive job, once its pilot (the samples from which the plan is made) is complete.
  std::optional<TilePlan> tile_plan;
  bool image_requested = false;  ///< WriteResult was returned in this epoch
  bool bands_on_disk = false;    ///< bands were stored and not dropped

  double error = -1;  ///< at `error_samples`; negative: unknown
  std::uint64_t error_samples = 0;
  ErrorCurve curve;
  /// The last estimate of the error, while the job must not use it yet. The job waits until its
  /// audits have a verdict, because pixels may be wrong until then.
  std::optional<input::PassMerged> pending_checkpoint;

  std::set<LeaseId> leases;
  /// The subset of `leases` that are backup tasks (second leases of late bands).
  std::set<LeaseId> backups;
  std::uint64_t backups_granted = 0;   ///< in this epoch
  std::deque<FailedAttempt> failures;  ///< the newest kMaxFailures
  std::deque<Suspicion> suspicions;    ///< the newest kMaxFailures
  /// Timeout clock: the time at which the scheduler found that no connected worker may render the
  /// job any more, and that a native worker (no browser) had failed too many of its bands.
  /// std::nullopt: the scheduler has not found this.
  std::optional<Time> unable_since;
  std::string log_of;            ///< the worker that failed a band last
  std::vector<std::string> log;  ///< the last lines of its log
  std::vector<Audit> audits;     ///< open, at most kMaxAudits
  /// Bands confirmed by a second machine, keyed with the process whose result is stored, because
  /// the stored result can be replaced by that of another process.
  std::set<std::pair<Band, WorkerProcessId>> audited;
  /// Journalled: disputes between a stored row and another result that are not decided, at most
  /// kMaxAudits. After a restart, an audit is opened for each of them.
  std::vector<record::RowDisputed> disputes;

  std::map<WorkerProcessId, WorkerShare> shares;  ///< at most kMaxShares
  std::optional<record::JobSummary> summary;      ///< for a final job
  std::vector<WorkerShare> final_shares;          ///< for a final job, descending

  WorkClock clock;           ///< starts at the first lease of this epoch or after a pause
  double elapsed_noted = 0;  ///< seconds in all epochs, as journalled last
  RecentRate throughput;     ///< pixel samples per second
  CostMap cost;
  RowTimes row_times;
  bool alone = false;  ///< a frame job that one worker is to render (dispatch/frame_chooser.h)
  /// Number of probe bands that were granted or skipped (dispatch/probes.h).
  std::uint32_t probes = 0;
  MeanRate work_rate;  ///< mean over its workers, per thread (dispatch/work_rate.h)

  /// These limits bound the memory of a job.
  static constexpr std::size_t kMaxFailures = 1'000;
  static constexpr std::size_t kMaxAudits = 4'096;
  static constexpr std::size_t kMaxShares = 65'536;
  static constexpr std::size_t kMaxFinalShares = 128;

 private:
  static constexpr std::size_t kPassesWithDigests = 8;
  std::optional<TileSchedule> schedule_;  ///< number of samples of half tiles in the next pass
  std::size_t complete_passes_ = 0;
};

}  // namespace bandsaw::coordinator
