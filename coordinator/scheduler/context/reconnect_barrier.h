#pragma once

// Reconnect barrier: after a restart of the coordinator, or after all workers were lost at once,
// nothing is leased until the former workers have reconnected or a grace time is over.
//
// The workers reconnect one by one. Until a worker has reconnected, its rows are free in the
// scheduler's data. Without the barrier, the first worker to reconnect would get rows that another
// worker has already rendered.

#include <cstddef>
#include <set>
#include <string>

#include "coordinator/scheduler/context/context.h"

namespace bandsaw::coordinator {

class ReconnectBarrier {
 public:
  explicit ReconnectBarrier(Context& context) : context_(context) {}

  /// Begins the grace time for all instances (worker processes) that were connected when the
  /// coordinator stopped.
  void begin_after_restart();
  /// MUST be called after a worker was disconnected. If no worker is left, probably the
  /// coordinator's own network failed. Then the workers that fell silent together are noted.
  void worker_lost();
  /// MUST be called when a worker connects. When the first of the workers that were lost together
  /// connects, the network is back, and the grace time for the others begins.
  void worker_connected(const Worker& worker);
  /// If the grace time is over, stops waiting, and writes to the journal that the missing workers
  /// have left.
  void expire();

  /// Returns true while nothing may be leased.
  bool active() const;
  /// Returns the number of workers that are waited for.
  std::size_t missing() const { return awaited_.size(); }

 private:
  void begin_grace();

  Context& context_;
  std::set<std::string> awaited_;  ///< instances that the barrier waits for
  /// Instances that fell silent together, until the first is back.
  std::set<std::string> lost_together_;
  Time until_ = 0;  ///< timeout clock: end of the grace time
};

}  // namespace bandsaw::coordinator
