#pragma once

// A simulated worker that is killed, frozen and disconnected, whose results are lost and repeated,
// and whose coordinator restarts.

#include <deque>
#include <memory>
#include <string>
#include <vector>

#include "sim_coordinator.h"
#include "sim_time.h"

namespace bandsaw::coordinator::sim {

struct Nature {
  double samples_per_s = 10'000;
  std::uint32_t threads = 1;
  std::uint32_t max_bands = 2;
  std::uint32_t number = 0;        ///< tells workers of the same name apart
  double fails = 0;                ///< share of its bands
  double hangs = 0;                ///< share of its bands; it hangs until they are revoked
  double lies = 0;                 ///< share of its rows
  double loses = 0.05;             ///< share of messages about bands, either way
  bool browser = false;            ///< it is a tab; a new process is the page loaded again
  std::uint64_t memory_bytes = 0;  ///< of its scenes; 0: no limit
  JobId dies_of = 0;               ///< the process crashes in the middle of a band of this job
  std::uint32_t dies_at_row = 0;   ///< if the band has this row; it is restarted
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
  void freeze(double seconds) { frozen_until_ = agenda_.now() + seconds; }
  void cut_cable();
  void drain();
  void calm_down() { nature_.fails = nature_.hangs = nature_.lies = nature_.loses = 0; }
  bool running() const { return running_; }

  std::uint64_t rendered = 0;
  std::uint64_t failed = 0;

 private:
  struct Stream {
    SessionId id = 0;
    std::uint64_t epoch_number = 0;
    bool open = true;
    double down_at = 0;  ///< arrival of the last message from the coordinator; the order is kept
    double up_at = 0;    ///< the same for messages to the coordinator
  };
  struct Held {
    action::Lease lease;
    std::string epoch;
    bool finished = false;
    std::vector<std::uint64_t> digests;
    double render_s = 0;
    double begun_at = -1;
    double prepared_at = -1;  ///< the scene is being fetched until then
    bool hangs = false;
  };

  /// Calls `what` after this time, unless the process has ended; a frozen process calls it later.
  void later(double seconds, std::function<void()> what);
  void connect();
  void disconnected(double wait);
  /// Sends an action of the coordinator to this worker.
  void down(const std::shared_ptr<Stream>& stream, const Action& action);
  /// Sends an input to the coordinator.
  void up(const Input& input);
  void receive(const Action& action);
  void take(const action::Lease& lease);
  void drop(LeaseId id);
  void render();
  bool has_deadly_row(const action::Lease& lease) const;
  /// Crashes; a new process starts after a second.
  void die();
  void finish(LeaseId id);
  void upload(LeaseId id);
  void send(const input::BandStored& band, LeaseId id);
  void heartbeat();
  Held* find(LeaseId id);

  Agenda& agenda_;
  Chance& chance_;
  SimCoordinator& coordinator_;
  std::string name_;
  Nature nature_;
  bool running_ = false;
  std::uint64_t process_ = 0;
  double frozen_until_ = 0;
  std::shared_ptr<Stream> stream_;
  std::string epoch_;
  std::set<JobId> scenes_;
  std::deque<Held> held_;
  LeaseId rendering_ = 0;
};

}  // namespace bandsaw::coordinator::sim
