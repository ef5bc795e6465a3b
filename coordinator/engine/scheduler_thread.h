#pragma once

// The scheduler's thread: it owns the scheduler and the journal (the log of decisions on disk). It
// writes the records of each step of the scheduler. Then it turns the actions of the step into
// messages to the other threads and to workers.

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/engine/clock.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/commit_queue.h"
#include "coordinator/engine/inboxes.h"
#include "coordinator/engine/links.h"
#include "coordinator/engine/watchers.h"
#include "coordinator/engine/worker_logs.h"
#include "coordinator/scheduler/scheduler.h"
#include "coordinator/store/journal.h"
#include "coordinator/store/reserve.h"

namespace bandsaw::coordinator {

class FilmThread;
class StoreThread;

/// Used by one thread at a time.
class SchedulerThread {
 public:
  /// `reserve`: a file that keeps disk space for the journal. It is removed when the disk is full,
  /// and made again when there is space. All references MUST outlive the object.
  SchedulerThread(SchedulerOptions options, Journal& journal, Reserve reserve, const Clock& clock,
                  StoreInbox& store, FilmInbox& film);

  /// Restores the state from the journal and the band logs; returns the error if one of them cannot
  /// be read. Call before any other method, while the other threads do not run yet. `disk`: OK, or
  /// the reason why the disk is full (disk_is_full).
  absl::Status restore(StoreThread& store, FilmThread& film, const absl::Status& disk);

  // Users.
  /// Runs Submit or SubmitSequence.
  void submit(const Input& input, Answer<JobId> answer);
  /// Runs Cancel, Pause, Resume, SetPriority, AddFrames or RetryFrames; the answer is the job after
  /// the command.
  void command(JobId job, const Input& input, Answer<JobView> answer);
  /// Runs Quarantine or LiftQuarantine.
  void command_worker(const Input& input, Answer<bool> answer);
  void watch(JobId job, Watchers::Changed changed);
  std::optional<JobView> job(JobId id) const { return scheduler_.job(id, clock_.now()); }
  /// Returns the frames of a sequence that changed after `after`; 0: all. NOT_FOUND: no such job.
  /// FAILED_PRECONDITION: the job is no sequence.
  absl::StatusOr<std::vector<FrameView>> frames(JobId id, std::uint64_t after) const;
  std::vector<std::string> why(JobId id) const { return scheduler_.why(id, clock_.now()); }
  std::vector<JobView> jobs(const JobPage& page) const {
    return scheduler_.jobs(clock_.now(), page);
  }
  std::vector<WorkerView> workers() const { return scheduler_.workers(clock_.now()); }

  // Workers.
  void hello(SessionId session, std::shared_ptr<WorkerLink> link, WorkerHello hello);
  void lost(SessionId session, std::string reason);
  /// Takes heartbeats and other inputs that concern only the scheduler.
  void observe(const Input& input) { run(input); }
  /// Takes a band from a worker. Gives it to the store, or answers it at once if the band is
  /// invalid, is not wanted, or cannot be stored now.
  void put_band(IncomingBand incoming);
  void add_worker_log(SessionId session, std::vector<std::string> lines);
  absl::StatusOr<std::vector<std::string>> worker_log(const std::string& worker) const {
    return logs_.of(worker);
  }

  // Messages of the store and the film (SchedulerInbox).
  /// The band is on disk, or all of its rows were stored before (IncomingBand::written).
  /// `row_digests`: digests of the rows of `incoming`.
  void band_stored(IncomingBand incoming, std::vector<std::uint64_t> row_digests);
  /// The band could not be written to disk.
  void band_failed(IncomingBand incoming, const absl::Status& status);
  /// The job's log no longer holds these bands, and the film has left them out.
  void bands_damaged(input::BandsDamaged damaged);
  /// OK: the files of the finished job are written. Otherwise `status` is the error.
  void result_written(JobId job, const absl::Status& status);
  /// Pauses a job whose data cannot be written or read now, until the disk takes data again.
  void storage_failed(JobId job, const absl::Status& status);
  /// The disk takes data again after a failed write.
  void disk_is_back();
  /// Forgets these final jobs.
  void forget(std::vector<JobId> jobs) { run(input::Forget{std::move(jobs)}); }

  /// Call after each batch: runs the clock's tick, writes the journal, runs the effects that waited
  /// for it, and informs the watchers.
  void settle();

  /// Returns true if the disk has space for new data. May be called on any thread.
  bool has_disk_space() const { return has_disk_space_; }

 private:
  /// Facts about a job that this thread needs without asking the scheduler.
  struct Known {
    JobSpec spec;
    JobState state = JobState::kRunning;
    std::vector<std::uint64_t> pass_ends;  ///< samples at which its planned passes end
  };
  /// Runs one step of the scheduler and puts its records and effects into the commit queue, where
  /// records wait for the journal and effects wait for the records. `incoming`: the band that the
  /// input is about, if any.
  Step run(const Input& input, IncomingBand* incoming = nullptr);
  /// Puts the records of a step and its actions, as effects, into the commit queue.
  void absorb(const Step& step, IncomingBand* incoming);
  /// Carries out one action: sends it to the store, the film, a worker, or the log.
  void perform(const Action& action);
  /// Updates known_.
  void note(const Record& record);
  /// Informs the store and the film of a new job or pass.
  void announce(const Record& record);
  /// Writes the journal and runs the effects that waited for it. Returns false if the journal
  /// cannot be written.
  bool flush();
  /// Called when the disk is full. Pauses all jobs, and refuses submits and bands until
  /// disk_is_back.
  void disk_is_full(const absl::Status& status);
  void pause_all(const absl::Status& status);
  void journal_failed(const absl::Status& status);
  absl::Status restore_job(JobId id, const Known& known, StoreThread& store, FilmThread& film);
  /// Returns true if the job is final or unknown.
  bool over(JobId id) const;
  /// Lets the store look for old jobs and blobs, at intervals.
  void collect();
  /// Rewrites the journal if it has become long.
  void compact();

  Scheduler scheduler_;
  Journal& journal_;
  Reserve reserve_;
  const Clock& clock_;
  StoreInbox& store_;
  FilmInbox& film_;
  CommitQueue commit_queue_;
  Links links_;
  Watchers watchers_;
  WorkerLogs logs_;
  std::map<JobId, Known> known_;
  std::set<JobId> results_on_the_way_;  ///< requested by the scheduler, not written yet
  absl::Status journal_status_;         ///< an error: nothing is acknowledged
  absl::Status disk_status_;  ///< an error: the reserve is released, no new data is accepted
  std::atomic<bool> has_disk_space_{true};  ///< disk_status_.ok(), for other threads
  Time ticked_at_ = 0;
  std::optional<Time> collected_at_;
  std::size_t added_since_ = 0;                           ///< jobs added since collected_at_
  static constexpr std::uint64_t kCompactAbove = 10'000;  ///< number of records in the journal
  std::uint64_t compact_above_ = kCompactAbove;
};

}  // namespace bandsaw::coordinator
