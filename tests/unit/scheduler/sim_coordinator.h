#pragma once

// The scheduler in a simulated coordinator: a journal that is synced late, bands that are on disk
// before the scheduler is informed, a film that merges late, a disk that is full at times, and
// crashes at any moment.

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

enum class PutOutcome { kStored, kDuplicate, kUnwanted, kTryAgain };

class SimCoordinator {
 public:
  SimCoordinator(Agenda& agenda, Chance& chance) : agenda_(agenda), chance_(chance) {}

  void start();
  /// Loses the data that is not synced, and all sessions.
  void crash();
  bool up() const { return scheduler_ != nullptr; }
  std::uint64_t epoch_number() const { return epoch_number_; }
  std::string epoch() const { return std::to_string(epoch_number_); }

  SessionId open(ToWorker link);
  void input(const Input& input);
  void put_band(const input::BandStored& band, std::function<void(PutOutcome)> reply);
  void fill_disk(double seconds);
  /// Damages records of a job's band log: some, the last ones, or all. The film may find it when it
  /// reads the log; otherwise the next start does.
  void damage_log();

  bool all_final() const;
  std::uint64_t package_bytes(JobId job) { return disk_[job].spec.package_bytes; }
  /// Notes the first thing that is wrong.
  void fail(const std::string& what);
  Scheduler& scheduler() { return *scheduler_; }

  /// The first invariant that did not hold.
  std::optional<std::string> broken;
  std::uint64_t steps = 0;
  std::uint64_t damages = 0;               ///< found by a film
  std::map<JobId, std::uint64_t> results;  ///< samples per pixel
  double time_skew = 0;                    ///< of the coordinator's clock
  double audit_share = 0;
  double browser_audit_share = 0.1;
  Browsers browsers = Browsers::kAlso;
  /// Requires that images have no wrong row. This holds only if every band is audited and machines
  /// that are right stay connected until the end.
  bool must_be_right = false;
  std::set<std::string> quarantined;  ///< names, in all epochs
  bool tear_steps = false;            ///< a crash may keep a part of a step's records

 private:
  struct Committing {
    Step step;
    std::vector<std::function<void()>> then;
    std::optional<input::BandStored> band;
  };
  struct OnDisk {
    JobSpec spec;
    std::vector<input::BandStored> bands;
    SimFilm stored;  ///< the bands that are in the image
  };
  /// Rows of a record that are in the film.
  struct Added {
    Band record;
    Band band;
    std::uint64_t process = 0;
  };
  struct Filming {
    SimFilm film;
    std::vector<Added> added;
    std::set<std::uint64_t> pass_ends;
    std::set<std::uint64_t> reported;
  };

  void take(Step step, std::function<void()> then = {});
  void commit();
  void perform(const Action& action, const std::optional<input::BandStored>& band);
  void check_lease(const action::Lease& lease, const std::set<LeaseId>& held);
  void take_stored(const input::BandStored& band, std::function<void()> then);
  void after(double seconds, std::function<void()> what);
  /// Runs the calls of the film late but in order, as on one thread.
  void on_film(std::function<void()> what);
  void write_band(input::BandStored band, std::function<void(PutOutcome)> reply);
  void add_to_film(JobId job, const input::BandStored& band, const std::vector<RowRange>& rows);
  void tell_passes(JobId job);
  void find_damage(JobId job, const std::vector<Added>& records);
  void take_damaged(const input::BandsDamaged& damaged);
  void write_result(const action::WriteResult& write);
  void note(const Record& record);
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
  double film_at_ = 0;       ///< when the film has finished its calls
  double disk_full_until_ = 0;
  std::set<LeaseId> held_;                 ///< named in the Hello of this step
  std::optional<input::BandStored> band_;  ///< of this step

  // Survives a crash.
  std::vector<Record> journal_;
  std::map<JobId, OnDisk> disk_;
};

}  // namespace bandsaw::coordinator::sim
