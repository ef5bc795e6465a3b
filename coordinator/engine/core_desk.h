#pragma once

// What the engine's thread does: it owns the core and the journal, and turns what the core decides
// into work for others.

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/engine/clock.h"
#include "coordinator/engine/collector.h"
#include "coordinator/engine/links.h"
#include "coordinator/engine/outbox.h"
#include "coordinator/engine/put_band.h"
#include "coordinator/engine/watchers.h"
#include "coordinator/engine/worker_logs.h"
#include "coordinator/scheduler/scheduler.h"
#include "coordinator/store/journal.h"
#include "coordinator/store/reserve.h"

namespace bandsaw::coordinator {

class FilmDesk;
class StoreDesk;

/// Used by one thread at a time.
class CoreDesk {
 public:
  /// Work for the other threads, handed over in the order of the calls.
  struct Hooks {
    std::function<void(JobId, const JobSpec&)> add_job;
    std::function<void(JobId, std::uint64_t samples)> plan_pass;
    std::function<void(PutBand)> store_band;
    std::function<void(PutBand)> compare_band;
    std::function<void(PutBand, std::vector<RowRange>)> add_to_film;
    std::function<void(JobId, std::uint64_t renderer)> retract;
    std::function<void(JobId, std::uint64_t samples)> make_result;
    std::function<void(JobId)> drop_bands;
    std::function<void(JobId)> drop_job;
    std::function<void(std::vector<Collector::Job>)> collect;
    std::function<void()> expect_trouble;
    std::function<void(bool there)> room;  ///< whether the disk has room for what is new
    std::function<void()> retry_film;
  };
  /// `reserve`: is released when the journal has no room, and held again when there is.
  CoreDesk(SchedulerOptions options, Journal& journal, Reserve reserve, const Clock& clock,
           Hooks hooks);

  /// Journal, bands and films as they were. Before any other call; the other threads MUST not run
  /// yet. `room`: OK, or why the disk is full (no_room).
  absl::Status restore(StoreDesk& store, FilmDesk& film, const absl::Status& room);

  // People.
  void submit(JobSpec spec, std::int32_t priority, Answer<JobId> answer);
  /// Cancel, Pause, Resume or SetPriority of a job; answered with what it is then.
  void tell(JobId job, const Input& input, Answer<JobView> answer);
  /// Quarantine or LiftQuarantine of a worker.
  void tell_of_worker(const Input& input, Answer<bool> answer);
  void watch(JobId job, Watchers::Changed changed);
  std::optional<JobView> job(JobId id) const { return core_.job(id, clock_.now()); }
  std::vector<std::string> why(JobId id) const { return core_.why(id, clock_.now()); }
  std::vector<JobView> jobs() const { return core_.jobs(clock_.now()); }
  std::vector<WorkerView> workers() const { return core_.workers(clock_.now()); }

  // Workers.
  void hello(SessionId session, std::shared_ptr<WorkerLink> link, WorkerHello hello);
  void lost(SessionId session, std::string reason);
  /// Heartbeats and what else needs nothing but the core.
  void hear(const Input& input) { run(input); }
  void put_band(PutBand put);
  void worker_log(SessionId session, std::vector<std::string> lines);
  absl::StatusOr<std::vector<std::string>> worker_log(const std::string& worker) const {
    return logs_.of(worker);
  }

  // The other threads.
  void band_stored(PutBand put, std::vector<std::uint64_t> row_digests);
  void band_failed(PutBand put, const absl::Status& status);
  void bands_damaged(input::BandsDamaged damaged);
  void result_written(JobId job, const absl::Status& status);
  void storage_failed(JobId job, const absl::Status& status);
  void disk_is_back();
  void forget(std::vector<JobId> jobs) { run(input::Forget{std::move(jobs)}); }

  /// After each batch: the clock's tick, the journal, everything that waited for it, and those who
  /// watch.
  void settle();

 private:
  /// What is known of a job beside the core.
  struct Known {
    JobSpec spec;
    JobState state = JobState::kRunning;
    std::vector<std::uint64_t> pass_ends;
  };
  /// One step of the core; what it led to goes into the outbox. `put`: the band the input is about,
  /// if any.
  Step run(const Input& input, PutBand* put = nullptr);
  void absorb(const Step& step, PutBand* put);
  void perform(const Action& action);
  void note(const Record& record);
  void tell_others(const Record& record);
  bool flush();
  /// The disk is full: until `disk_is_back` jobs are paused, and submits and bands refused.
  void no_room(const absl::Status& status);
  void pause_all(const absl::Status& status);
  void journal_failed(const absl::Status& status);
  absl::Status restore_job(JobId id, const Known& known, StoreDesk& store, FilmDesk& film);
  bool over(JobId id) const;
  void collect();
  void compact();

  Scheduler core_;
  Journal& journal_;
  Reserve reserve_;
  const Clock& clock_;
  Hooks hooks_;
  Outbox outbox_;
  Links links_;
  Watchers watchers_;
  WorkerLogs logs_;
  std::map<JobId, Known> known_;
  std::set<JobId> results_on_the_way_;  ///< asked for by the core, not answered yet
  absl::Status journal_status_;         ///< an error: nothing is acknowledged
  absl::Status room_;                   ///< an error: the reserve is released, nothing new is taken
  Time ticked_at_ = 0;
  std::optional<Time> collected_at_;
  std::size_t added_since_ = 0;                           ///< jobs, since then
  static constexpr std::uint64_t kCompactAbove = 10'000;  ///< records in the journal
  std::uint64_t compact_above_ = kCompactAbove;
};

}  // namespace bandsaw::coordinator
