// Workers that are awaited: after the coordinator's restart, or when all of them were lost at once.
//
// They come back one by one, with rows in hand that are free now. Were the first given any, it
// would be given what another has rendered.

#include "coordinator/core/state.h"

namespace bandsaw::coordinator {

/// Its last words are two heartbeats old: the net ended the session, or nobody did yet.
bool Core::State::is_silent(const Worker& worker) const {
  return clock_.patience() - worker.heard_at > 2 * options_.heartbeat_interval_s;
}

/// When nobody is left, it was the coordinator's own cable that failed rather than each of theirs.
void Core::State::note_those_lost_together() {
  if (workers_.connected() > 0) {
    return;
  }
  lost_together_.clear();
  for (const auto& [id, worker] : workers_.all()) {
    const bool lately = clock_.patience() - worker.heard_at <= 2 * options_.heartbeat_timeout_s;
    if (worker.fell_silent && lately && !worker.draining && !worker.quarantined) {
      lost_together_.insert(worker.instance);
    }
  }
}

/// With one of them the net is back: from now on the others have as long as after a restart.
void Core::State::await_rest_of_former(const Worker& back) {
  if (lost_together_.contains(back.instance)) {
    former_.merge(std::exchange(lost_together_, {}));
    awaited_until_ = clock_.patience() + options_.reattach_grace_s;
  }
  former_.erase(back.instance);
}

bool Core::State::waits_for_former() const {
  return !former_.empty() && clock_.patience() < awaited_until_;
}

void Core::State::give_up_on_former() {
  if (former_.empty() || waits_for_former()) {
    return;
  }
  for (const std::string& instance : std::exchange(former_, {})) {
    if (joined_.contains(instance)) {
      emit(record::WorkerLeft{instance});
    }
  }
}

}  // namespace bandsaw::coordinator
