#pragma once

// A simulated coordinator, in which tests run the real scheduler in virtual time. Its journal is
// synced late, bands are on disk before the scheduler is informed, its film (the accumulators of an
// image) merges them late, its disk is full at times, and it crashes at any moment. It also checks
// what the scheduler does: no row is in an image twice, leased although it is stored, or missing.

#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "coordinator/scheduler/scheduler.h"
#include "sim_film.h"
#include "sim_time.h"

namespace bandsaw::coordinator::sim {

/// Sends an action to a worker.
using ToWorker = std::function<void(const Action&)>;

/// Answer to a worker that sent a band. kDuplicate: all its rows were stored already. kUnwanted:
/// its job is over or not known. kTryAgain: the disk is full; the worker keeps the band.
enum class PutOutcome { kStored, kDuplicate, kUnwanted, kTryAgain };

/// A pass is a range of samples that is rendered for all rows. A worker is quarantined, that is,
/// gets no more work, when its pixels were wrong.
class SimCoordinator {
 public:
  SimCoordinator(Agenda& agenda, Chance& chance) : agenda_(agenda), chance_(chance) {}

  /// Starts a new epoch: a scheduler that replays the journal and the bands on disk.
  void start();
  /// Loses the data that is not synced, and all sessions.
  void crash();
  bool up() const { return scheduler_ != nullptr; }
  std::uint64_t epoch_number() const { return epoch_number_; }
  std::string epoch() const { return std::to_string(epoch_number_); }

  /// Opens a session with a worker. `link` sends actions to it. The coordinator MUST be up.
  SessionId open(ToWorker link);
  /// Gives an input to the scheduler; ignored while the coordinator is down.
  void input(const Input& input);
  /// Takes a band of a worker. The coordinator MUST be up. `reply` is called at once or later. It
  /// is not called if the coordinator crashes before.
  void put_band(const input::BandStored& band, std::function<void(PutOutcome)> reply);
  /// Lets all writes of bands and results fail for this time.
  void fill_disk(double seconds);
  /// Damages the band log of a random job: random records, all records, or all records from a
  /// random one on. The damage is found by the film while the coordinator runs, or at the next
  /// start.
  void damage_log();

  /// Returns true if the coordinator is up and each of its jobs is final.
  bool all_final() const;
  std::uint64_t package_bytes(JobId job) { return disk_[job].spec.package_bytes; }
  /// Sets `broken` to `what` with the time and the epoch, unless `broken` is set already.
  void fail(const std::string& what);
  Scheduler& scheduler() { return *scheduler_; }

  /// The first thing that was wrong: a broken invariant, or a wrong image. std::nullopt: nothing.
  std::optional<std::string> broken;
  std::uint64_t steps = 0;                 ///< of the scheduler
  std::uint64_t damages = 0;               ///< damaged logs that a film found
  std::map<JobId, std::uint64_t> results;  ///< samples per pixel of each finished image
  double time_skew = 0;  ///< seconds that the scheduler's clock is ahead of the virtual time
  // Options of the scheduler (SchedulerOptions), which are used at the next start(). To audit a
  // band, a second worker renders it again, and the results are compared.
  double audit_share = 0;
  double browser_audit_share = 0.1;
  Browsers browsers = Browsers::kAlso;
  /// Requires that no image has a wrong row. A farm with machines that return wrong pixels can
  /// fulfil this under two conditions: all bands of these machines are audited, and machines that
  /// return right pixels stay connected until the end.
  bool must_be_right = false;
  std::set<std::string> quarantined;  ///< names of workers that were quarantined in any epoch
  bool tear_steps = false;            ///< a crash may keep a part of a step's records

 private:
  /// A step of the scheduler whose records are not synced yet, so its actions wait.
  struct Committing {
    Step step;
    std::vector<std::function<void()>> then;  ///< called after the actions
    std::optional<input::BandStored> band;    ///< the band that the step stored
  };
  struct OnDisk {
    JobSpec spec;
    std::vector<input::BandStored> bands;
    SimFilm stored;  ///< the bands that are in the image
  };
  /// A part of a record of the band log that is in the film.
  struct Added {
    Band record;                ///< the whole band of the record
    Band band;                  ///< a range of its rows, all of which were added
    std::uint64_t process = 0;  ///< the process that rendered it
  };
  /// The film of a job in memory; a restart builds it again from the band log.
  struct Filming {
    SimFilm film;
    std::vector<Added> added;
    std::set<std::uint64_t> pass_ends;  ///< last samples of passes that are not reported as merged
    std::set<std::uint64_t> reported;   ///< last samples of passes that are reported as merged
  };

  /// Checks a step and commits it later; `then` is called after its actions.
  void take(Step step, std::function<void()> then = {});
  /// Adds the records of the oldest waiting step to the journal, and performs its actions.
  void commit();
  /// `band`: the band that the action's step stored, if any.
  void perform(const Action& action, const std::optional<input::BandStored>& band);
  /// Fails if a row of the lease is stored already. Audits and leases in `held` are exempt.
  void check_lease(const action::Lease& lease, const std::set<LeaseId>& held);
  /// Gives a band to the scheduler, to be stored or compared. `then` is called after the step's
  /// actions.
  void take_stored(const input::BandStored& band, std::function<void()> then);
  /// Calls `what` after this time, unless the coordinator has crashed.
  void after(double seconds, std::function<void()> what);
  /// Calls `what` later, after all earlier calls that were given to on_film, as on one thread.
  void on_film(std::function<void()> what);
  /// Puts a band on disk and gives it to the scheduler. Calls `reply` when the scheduler's records
  /// are in the journal.
  void write_band(input::BandStored band, std::function<void(PutOutcome)> reply);
  /// Merges these rows of a band into the film of the job.
  void add_to_film(JobId job, const input::BandStored& band, const std::vector<RowRange>& rows);
  /// Reports to the scheduler each pass whose samples are all in the film.
  void tell_passes(JobId job);
  /// Removes the damaged records from the film, and reports them to the scheduler later.
  void find_damage(JobId job, const std::vector<Added>& records);
  /// Gives a report of damaged bands to the scheduler. The bands that the scheduler declares lost
  /// are no longer stored.
  void take_damaged(const input::BandsDamaged& damaged);
  /// Writes the image, as soon as the film has all its samples, and checks it.
  void write_result(const action::WriteResult& write);
  /// Keeps the parts of a record that the simulation needs: jobs, quarantines, ends of passes.
  void note(const Record& record);
  /// Sends a Tick to the scheduler now, and again and again until the coordinator crashes.
  void tick();

  Agenda& agenda_;
  Chance& chance_;
  std::unique_ptr<Scheduler> scheduler_;
  std::uint64_t epoch_number_ = 0;
  SessionId next_session_ = 1;
  std::map<SessionId, ToWorker> links_;
  std::deque<Committing> committing_;
  std::map<JobId, Filming> films_;
  std::set<JobId> writing_;  ///< jobs whose results were requested
  double film_at_ = 0;       ///< when the film will have finished the calls it was given
  double disk_full_until_ = 0;
  std::set<LeaseId> held_;                 ///< leases that the Hello of the present step names
  std::optional<input::BandStored> band_;  ///< band that the present step stores

  // The journal and the disk survive a crash.
  std::vector<Record> journal_;
  std::map<JobId, OnDisk> disk_;
};

}  // namespace bandsaw::coordinator::sim
