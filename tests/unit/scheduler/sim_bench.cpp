// Drives the scheduler in virtual time: simulated workers take leases, wait for the time that the
// rows of the band cost, and send results.

#include "sim_bench.h"

#include <algorithm>
#include <deque>
#include <map>
#include <utility>

#include "farm_driver.h"
#include "sim_time.h"

namespace bandsaw::coordinator::sim {
namespace {

/// One run: a scheduler, one job, and workers. Worker i has session i + 1.
class Bench {
 public:
  explicit Bench(const BenchFarm& farm)
      : farm_(farm), chance_(farm.seed), scheduler_(options(farm)), workers_(farm.speeds.size()) {}

  BenchResult run() {
    JobSpec spec = test_job("bench", StopAtSamples{farm_.samples}, farm_.width, farm_.height);
    take(scheduler_.step(input::Submit{spec}, 0));
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      agenda_.in(chance_.between(0, 0.01), [this, i] { hello(i); });
      beat(i);
    }
    tick();
    // A job that is not over after 1e5 seconds, a hundred times its planned time, is given up.
    while (!over_ && agenda_.now() < 1e5 && result_.broken.empty() && agenda_.run_next()) {
    }
    finish();
    return result_;
  }

 private:
  static SchedulerOptions options(const BenchFarm& farm) {
    SchedulerOptions options = test_options();
    options.audit_share = farm.audit_share;
    return options;
  }

  /// The state of a worker.
  struct Busy {
    std::deque<action::Lease> queue;  ///< the first is being rendered
    double begun_at = -1;             ///< when the first was begun
    double takes = 0;                 ///< seconds that the first takes
    double idle_since = 0;            ///< if the queue is empty
    /// Number of calls of begin(). If the number has grown between the beginning and the end of a
    /// band, the band was revoked, and its end is ignored.
    std::uint64_t turn = 0;
  };

  /// Lets worker i join, with the versions of test_options().
  void hello(std::size_t i) {
    WorkerHello hello;
    hello.instance = hello.name = std::to_string(i + 1);
    hello.protocol = 1;
    hello.pixel_version = 2;
    hello.canary = 3;
    hello.threads = farm_.threads;
    hello.max_bands = 3;
    take(scheduler_.step(input::Hello{i + 1, hello}, agenda_.now()));
  }

  /// Sends a Tick to the scheduler and notes the remaining time that it predicts, every 0.1 s.
  void tick() {
    take(scheduler_.step(input::Tick{}, agenda_.now()));
    predicted_left_[agenda_.now()] = scheduler_.job(1, agenda_.now())->remaining_s;
    agenda_.in(0.1, [this] { tick(); });
  }

  /// Sends a heartbeat of worker i each second.
  void beat(std::size_t i) {
    agenda_.in(1, [this, i] {
      input::Heartbeat beat{i + 1, {}, "rendering"};
      const Busy& worker = workers_[i];
      for (const action::Lease& lease : worker.queue) {
        const bool first = lease.lease == worker.queue.front().lease;
        const double done = first ? (agenda_.now() - worker.begun_at) / worker.takes : 0;
        beat.leases.push_back(
            {lease.lease, static_cast<std::uint32_t>(std::min(1.0, done) * lease.band.rows.count()),
             0});
      }
      agenda_.in(farm_.trip_s, [this, beat] { take(scheduler_.step(beat, agenda_.now())); });
      this->beat(i);
    });
  }

  /// Checks the scheduler's invariants and carries out the actions of the step.
  void take(const Step& step) {
    if (const auto broken = scheduler_.broken_invariant(); broken && result_.broken.empty()) {
      result_.broken = *broken;
    }
    for (const Action& action : step.actions) {
      if (const auto* lease = std::get_if<action::Lease>(&action)) {
        first_lease_ = first_lease_ < 0 ? agenda_.now() : first_lease_;
        agenda_.in(farm_.trip_s, [this, l = *lease] { receive(l); });
      } else if (const auto* revoke = std::get_if<action::Revoke>(&action)) {
        agenda_.in(farm_.trip_s, [this, r = *revoke] {
          for (const LeaseId id : r.leases) {
            drop(r.session - 1, id);
          }
        });
      } else if (std::holds_alternative<action::WriteResult>(action)) {
        over_ = true;
      }
    }
  }

  void receive(const action::Lease& lease) {
    Busy& worker = workers_[lease.session - 1];
    worker.queue.push_back(lease);
    if (worker.queue.size() == 1) {
      begin(lease.session - 1);
    }
  }

  /// Lets worker i begin the first lease of its queue. If the queue is empty, the worker is idle.
  void begin(std::size_t i) {
    Busy& worker = workers_[i];
    ++worker.turn;
    if (worker.queue.empty()) {
      worker.idle_since = agenda_.now();
      return;
    }
    const Band& band = worker.queue.front().band;
    double work = 0;
    for (std::uint32_t row = band.rows.first; row < band.rows.last; ++row) {
      work += farm_.cost_of(row);
    }
    work *= static_cast<double>(band.samples.samples()) * farm_.width;
    const bool stalled = i == 0 && farm_.stalls_at >= 0 && agenda_.now() >= farm_.stalls_at;
    worker.begun_at = agenda_.now();
    worker.takes = work / farm_.speeds[i] * (stalled ? 100 : 1) *
                   chance_.between(1 - farm_.noise, 1 + farm_.noise);
    agenda_.in(worker.takes, [this, i, turn = worker.turn] {
      if (workers_[i].turn == turn) {
        rendered(i);
      }
    });
  }

  /// Sends the first band of worker i's queue, which is finished, and begins the next one.
  void rendered(std::size_t i) {
    Busy& worker = workers_[i];
    input::BandStored stored;
    stored.job = worker.queue.front().job;
    stored.band = worker.queue.front().band;
    stored.row_digests = honest_digests(stored.band);
    stored.instance = std::to_string(i + 1);
    stored.render_s = worker.takes;
    worker.queue.pop_front();
    agenda_.in(farm_.upload_s, [this, stored]() mutable {
      ++result_.bands;
      const auto wanted = scheduler_.wanted(stored.job, stored.band);
      stored.written = wanted && !wanted->empty();
      result_.wasted += stored.written ? 0 : 1;
      take(scheduler_.step(stored, agenda_.now()));
    });
    begin(i);
  }

  /// Removes a revoked lease from the queue of worker i.
  void drop(std::size_t i, LeaseId id) {
    Busy& worker = workers_[i];
    const bool first = !worker.queue.empty() && worker.queue.front().lease == id;
    result_.wasted += first ? 1 : 0;
    std::erase_if(worker.queue, [&](const action::Lease& l) { return l.lease == id; });
    if (first) {
      begin(i);
    }
  }

  /// Computes the results of the whole run.
  void finish() {
    if (!over_ && result_.broken.empty()) {
      result_.broken = "the job did not come to its end";
    }
    result_.seconds = agenda_.now() - first_lease_;
    const auto quarter = predicted_left_.lower_bound(first_lease_ + result_.seconds / 4);
    result_.predicted_left = quarter->second / (agenda_.now() - quarter->first);
    double work = 0;
    for (std::uint32_t row = 0; row < farm_.height; ++row) {
      work += farm_.cost_of(row);
    }
    work *= static_cast<double>(farm_.samples) * farm_.width;
    double possible_work = 0;
    double first_idle = agenda_.now();
    for (std::size_t i = 0; i < workers_.size(); ++i) {
      possible_work += farm_.speeds[i] * result_.seconds;
      first_idle =
          workers_[i].queue.empty() ? std::min(first_idle, workers_[i].idle_since) : first_idle;
    }
    result_.efficiency = work / possible_work;
    result_.tail = (agenda_.now() - first_idle) / result_.seconds;
  }

  BenchFarm farm_;
  Agenda agenda_;
  Chance chance_;
  Scheduler scheduler_;
  std::vector<Busy> workers_;
  BenchResult result_;
  /// For each time, the remaining seconds that the scheduler predicted then.
  std::map<double, double> predicted_left_;
  double first_lease_ = -1;
  bool over_ = false;
};

}  // namespace

BenchResult run_bench(const BenchFarm& farm) { return Bench(farm).run(); }

}  // namespace bandsaw::coordinator::sim
