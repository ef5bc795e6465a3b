#pragma once

// The common base of simulated farms: their parts, the storm in which things fail, and jobs that
// are submitted until the coordinator knows them.

#include <memory>
#include <vector>

#include "sim_coordinator.h"
#include "sim_worker.h"

namespace bandsaw::coordinator::sim {

class SimulatedFarm {
 protected:
  static constexpr double kStorm = 40;  ///< seconds, from the beginning

  explicit SimulatedFarm(std::uint64_t seed) : chance_(seed), coordinator_(agenda_, chance_) {}

  /// Returns true if there are so many jobs, and all are final.
  bool over(std::size_t jobs) {
    return coordinator_.all_final() && coordinator_.scheduler().jobs(agenda_.now()).size() == jobs;
  }

  /// Calls `send` now and every five seconds until 20 s after the storm, if the coordinator is up:
  /// a crash may have lost what was sent.
  template <class Send>
  void keep_sending(Send send) {
    if (coordinator_.up()) {
      send();
    }
    agenda_.in(5, [this, send] {
      if (agenda_.now() < kStorm + 20) {
        keep_sending(send);
      }
    });
  }

  void submit(const JobSpec& job) {
    keep_sending([this, job] { coordinator_.input(input::Submit{job}); });
  }

  /// Runs the farm until `jobs` jobs are over and `calm_s` seconds have passed since the storm; at
  /// most until `end`, or until something is wrong.
  void run_until_over(std::size_t jobs, double calm_s, double end) {
    while (agenda_.now() < end && !coordinator_.broken) {
      if (!agenda_.run_next() || (agenda_.now() > kStorm + calm_s && over(jobs))) {
        break;
      }
    }
  }

  Agenda agenda_;
  Chance chance_;
  SimCoordinator coordinator_;
  std::vector<std::unique_ptr<SimWorker>> workers_;
};

}  // namespace bandsaw::coordinator::sim
