#pragma once

// A simulated worker in virtual time. Tests kill, freeze and disconnect it; its results are lost,
// delayed and repeated; its coordinator restarts. A lease gives a band (a range of rows and
// samples) to the worker.

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "sim_coordinator.h"
#include "sim_time.h"

namespace bandsaw::coordinator::sim {

/// How a simulated worker behaves.
struct Nature {
  double samples_per_s = 10'000;  ///< pixel samples
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 2;  ///< leases that it holds at once, at most
  std::uint32_t number = 0;     ///< distinguishes the processes of workers of the same name
  double fails = 0;             ///< share of its bands that it cannot render
  double hangs = 0;             ///< share of its bands that it never finishes; they are revoked
  double lies = 0;              ///< share of its rows that have wrong pixels
  /// Share of the results that are lost or arrive twice, and of the acknowledgements that are lost.
  double loses = 0.05;
  bool browser = false;            ///< it is a tab; each new process is a reload of the page
  std::uint64_t memory_bytes = 0;  ///< for scenes; 0: no limit
  /// The process crashes at the end of each band of the job `dies_of` that has the row
  /// `dies_at_row`, and is restarted. If `dies_of` is 0, the process never crashes by itself.
  JobId dies_of = 0;
  std::uint32_t dies_at_row = 0;
};

class SimWorker {
 public:
  SimWorker(Agenda& agenda, Chance& chance, SimCoordinator& coordinator, std::string name,
            const Nature& nature)
      : agenda_(agenda),
        chance_(chance),
        coordinator_(coordinator),
        name_(std::move(name)),
        nature_(nature) {}

  /// Starts a new process.
  void start();
  void kill();
  /// The process does nothing for this time, as if it were stopped by SIGSTOP.
  void freeze(double seconds) { frozen_until_ = agenda_.now() + seconds; }
  /// Ends the connection; the coordinator notices it late or not at all. The worker reconnects.
  void cut_cable();
  /// Announces that it finishes its leases and takes no more.
  void drain();
  /// Ends all random failures of the worker: wrong, failed and hanging bands, and lost messages.
  void calm_down() { nature_.fails = nature_.hangs = nature_.lies = nature_.loses = 0; }
  bool running() const { return running_; }

  std::uint64_t rendered = 0;  ///< bands, including those that failed
  std::uint64_t failed = 0;    ///< bands

 private:
  /// A connection to the coordinator.
  struct Stream {
    SessionId id = 0;
    std::uint64_t epoch_number = 0;
    bool open = true;
    /// Time at which the newest message from the coordinator arrives. A message that is sent later
    /// does not arrive earlier.
    double down_at = 0;
    double up_at = 0;  ///< time at which the newest message to the coordinator arrives
  };
  /// A lease, which the worker holds until the result is acknowledged.
  struct Held {
    action::Lease lease;
    std::string epoch;      ///< of the coordinator that granted or confirmed the lease
    bool finished = false;  ///< rendered, but not acknowledged
    std::vector<std::uint64_t> digests;
    double render_s = 0;      ///< seconds that rendering takes, without the scene
    double begun_at = -1;     ///< negative: not begun
    double prepared_at = -1;  ///< time at which the scene will have been fetched
    bool hangs = false;
  };

  /// Calls `what` after this time, unless the process has ended; a frozen process calls it later.
  void later(double seconds, std::function<void()> what);
  /// Returns the name of the current process, under which the farm knows it.
  std::string instance() const;
  void connect();
  /// Connects again after `wait` seconds.
  void disconnected(double wait);
  /// Sends an action of the coordinator to this worker.
  void down(const std::shared_ptr<Stream>& stream, const Action& action);
  /// Sends an input to the coordinator.
  void up(const Input& input);
  /// Carries out an action of the coordinator.
  void receive(const Action& action);
  /// Takes a new lease, or notes that the coordinator has confirmed a lease after a reconnect.
  void take(const action::Lease& lease);
  /// Ends a lease. If its band is being rendered, the next band is begun instead.
  void drop(LeaseId id);
  /// Begins the first band that is not finished, unless a band is being rendered.
  void render();
  /// Returns true if the lease has the row at which the process crashes (Nature).
  bool has_deadly_row(const action::Lease& lease) const;
  /// Crashes; a new process starts after a second.
  void die();
  /// Ends a rendered band: reports a failure or uploads the result, and renders the next band.
  void finish(LeaseId id);
  /// Sends the result of a lease, and repeats this until it is acknowledged.
  void upload(LeaseId id);
  /// Lets a result arrive at the coordinator. The lease `id` is dropped when the reply arrives.
  void send(const input::BandStored& band, LeaseId id);
  /// Sends a heartbeat each second. If the coordinator has crashed, the worker reconnects.
  void heartbeat();
  Held* find(LeaseId id);

  Agenda& agenda_;
  Chance& chance_;
  SimCoordinator& coordinator_;
  std::string name_;
  Nature nature_;
  bool running_ = false;
  std::uint64_t process_ = 0;  ///< number of processes started so far
  double frozen_until_ = 0;
  std::shared_ptr<Stream> stream_;
  std::string epoch_;
  std::set<JobId> scenes_;  ///< jobs whose scenes it has fetched
  std::deque<Held> held_;
  LeaseId rendering_ = 0;  ///< 0: none
};

}  // namespace bandsaw::coordinator::sim
