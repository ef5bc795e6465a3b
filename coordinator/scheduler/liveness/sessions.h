#pragma once

// Sessions of workers, that is, their streams to the coordinator: admission, the leases that a
// worker still holds when it reconnects, heartbeats, and loss.

#include <deque>
#include <string>
#include <vector>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/context/reconnect_barrier.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"
#include "coordinator/scheduler/liveness/crash_attribution.h"

namespace bandsaw::coordinator {

/// A worker that was not admitted, as it is shown to users.
struct Refusal {
  std::string instance;
  WorkerView worker;
  Time at = 0;  ///< wall clock
};

class Sessions {
 public:
  Sessions(Context& context, LeaseLedger& ledger, ReconnectBarrier& barrier,
           CrashAttribution& crashes)
      : context_(context), ledger_(ledger), barrier_(barrier), crashes_(crashes) {}

  /// Admits a worker, or refuses it with a reason. Leases that the worker still holds are kept or
  /// revoked. Leases that it does not hold any more are ended.
  void hello(const input::Hello& in);
  /// Notes that the worker lives, and the progress of its leases.
  void heartbeat(const input::Heartbeat& in);
  /// The worker is about to leave: it gets no more leases.
  void draining(const input::Draining& in);
  /// The stream has ended: disconnects the worker.
  void ended(const input::SessionEnded& in);

  /// Ends the worker's session and leases.
  void disconnect(Worker& worker, const std::string& reason);
  /// Disconnects workers that have been silent for the heartbeat timeout.
  void check_silence();
  /// Forgets old refusals of workers that have not tried again. A refusal is kept for three times
  /// the time that the worker was told to wait.
  void forget_refusals();
  /// Returns the newest kMaxRefusals refusals, the oldest first.
  const std::deque<Refusal>& refusals() const { return refusals_; }

 private:
  static constexpr std::size_t kMaxRefusals = 32;

  /// Returns true if there is no place for one more worker. Browsers cannot take all places.
  bool is_full(const WorkerHello& worker) const;
  /// Refuses the worker, and keeps the refusal, so that it is shown to users.
  void refuse(const input::Hello& in, const std::string& reason);
  /// Connects the worker, and decides which of the leases that it still holds it may keep.
  void admit(Worker& worker, const input::Hello& in);
  void reconcile_leases(Worker& worker, const std::vector<WorkerHello::Held>& held);
  bool keep_lease(Worker& worker, const WorkerHello::Held& held);

  Context& context_;
  LeaseLedger& ledger_;
  ReconnectBarrier& barrier_;
  CrashAttribution& crashes_;
  std::deque<Refusal> refusals_;
};

}  // namespace bandsaw::coordinator
