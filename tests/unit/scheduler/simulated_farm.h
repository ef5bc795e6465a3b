#pragma once

// The common base of simulated farms (simulation_test, tabs_simulation_test): a coordinator and
// workers in virtual time. Things fail only in the first kStorm seconds; after that every job must
// end.

#include <memory>
#include <vector>

#include "sim_coordinator.h"
#include "sim_worker.h"

namespace bandsaw::coordinator::sim {

class SimulatedFarm {
 protected:
  /// Length of the storm, in seconds from the beginning. Things fail only in the storm. It is long
  /// enough for the timeouts of the simulated coordinator, 4 to 8 s, to expire several times.
  static constexpr double kStorm = 40;

  explicit SimulatedFarm(std::uint64_t seed) : chance_(seed), coordinator_(agenda_, chance_) {}

  /// Returns true if the coordinator is up, knows exactly `jobs` jobs, and all are final.
  bool over(std::size_t jobs) {
    return coordinator_.all_final() && coordinator_.scheduler().jobs(agenda_.now()).size() == jobs;
  }

  /// Calls `send` now and every five seconds until 20 s after the storm, each time only if the
  /// coordinator is up. The call is repeated because a crash may have lost what was sent.
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

  /// Runs the farm until `jobs` jobs are final and the storm ended more than `calm_s` seconds ago.
  /// The run ends early at the time `end`, in seconds, or as soon as something is wrong.
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
