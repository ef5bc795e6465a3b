// While the barrier is active, nothing is leased. It begins after a restart. If all workers fell
// silent together, it also begins when the first of them reconnects. The barrier ends when all
// workers that it waits for have reconnected or the grace time is over.

#include "coordinator/scheduler/context/reconnect_barrier.h"

#include <utility>

namespace bandsaw::coordinator {

void ReconnectBarrier::begin_grace() {
  until_ = context_.clock.timeout_clock() + context_.options.reattach_grace_s;
}

void ReconnectBarrier::begin_after_restart() {
  awaited_ = context_.joined;
  begin_grace();
}

void ReconnectBarrier::worker_lost() {
  if (context_.workers.connected() > 0) {
    return;
  }
  lost_together_.clear();
  const Time now = context_.clock.timeout_clock();
  for (const auto& [id, worker] : context_.workers.all()) {
    const bool lately = now - worker.heard_at <= 2 * context_.options.heartbeat_timeout_s;
    if (worker.fell_silent && lately && !worker.draining && !worker.quarantined) {
      lost_together_.insert(worker.instance);
    }
  }
}

void ReconnectBarrier::worker_connected(const Worker& worker) {
  if (lost_together_.contains(worker.instance)) {
    awaited_.merge(std::exchange(lost_together_, {}));
    begin_grace();
  }
  awaited_.erase(worker.instance);
}

bool ReconnectBarrier::active() const {
  return !awaited_.empty() && context_.clock.timeout_clock() < until_;
}

void ReconnectBarrier::expire() {
  if (awaited_.empty() || active()) {
    return;
  }
  for (const std::string& instance : std::exchange(awaited_, {})) {
    if (context_.joined.contains(instance)) {
      context_.emit(record::WorkerLeft{instance});
    }
  }
}

}  // namespace bandsaw::coordinator
