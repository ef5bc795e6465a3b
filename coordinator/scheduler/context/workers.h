#pragma once

// Keeps the connected workers and, for a while, the workers that have left. Lists the workers that
// can take a lease (the assignment of a band of rows and samples to a worker). Each time is of one
// of the two clocks in scheduler_clock.h.

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/context/leases.h"
#include "coordinator/scheduler/model/audit.h"
#include "coordinator/scheduler/model/rates.h"

namespace bandsaw::coordinator {

/// A worker process, over all its reconnects.
struct Worker {
  WorkerId id = 0;
  std::string instance;         ///< id that the process chose for itself when it started
  WorkerProcessId process = 0;  ///< hash of the instance
  std::string name;             ///< displayed; unique among the known workers
  /// The name that it reports. A native worker reports the name of its machine. The name of a
  /// browser is chosen freely, and ends with kBrowserSuffix (api/messages.h).
  std::string reported_name;
  std::string address;
  std::string build;
  std::uint32_t threads = 1;
  std::uint32_t credits = 1;         ///< number of leases it may hold
  bool browser = false;              ///< it renders in a browser
  std::uint64_t memory_bytes = 0;    ///< memory that scenes may take in it; 0: no limit
  std::optional<SessionId> session;  ///< std::nullopt: not connected
  /// It announced that it will leave, so it gets no more leases.
  bool draining = false;
  bool fell_silent = false;     ///< it was silent when it was disconnected last
  bool quarantined = false;     ///< it gets no more work
  std::string doing;            ///< what it says it does, for display; may be empty
  std::string reason;           ///< why it is disconnected, draining or quarantined
  Time connected_at = 0;        ///< wall clock
  Time heard_at = 0;            ///< timeout clock: last message
  std::vector<LeaseId> leases;  ///< in the order granted, in which it renders them
  /// Revoked leases that its heartbeats may still name: it may be rendering one of them.
  std::set<LeaseId> revoked;
  MeanRate speed;  ///< pixel samples per second, for display

  /// Statistics of one job that is not final. For a sequence (a job of many frames), only
  /// `work_rate` is set: it is the first estimate for the sequence's next frame job.
  struct OnJob {
    MeanRate speed;              ///< pixel samples per second, for display
    MeanRate work_rate;          ///< work per second (model/row_costs.h), by which bands are sized
    std::uint32_t bands = 0;     ///< bands of the job that were measured
    std::uint32_t failures = 0;  ///< bands that it failed since it last stored one
  };
  std::map<JobId, OnJob> on_job;

  /// Returns the identifier of its machine: the reported name, or the instance of a browser. A
  /// browser's name identifies no machine, so each tab counts as a machine of its own.
  const std::string& machine() const { return browser ? instance : reported_name; }
  Reporter reporter() const {
    return {.process = process, .machine = machine(), .browser = browser};
  }
  /// Returns true if it is connected and may get leases.
  bool eligible() const { return session && !draining && !quarantined; }
  bool has_spare_credit() const { return eligible() && leases.size() < credits; }
};

class Workers {
 public:
  Worker* by_id(WorkerId id);
  const Worker* by_id(WorkerId id) const;
  Worker* by_session(SessionId session);
  Worker* by_instance(const std::string& instance);
  const Worker* by_instance(const std::string& instance) const;
  /// Searches all workers: only for rare events.
  const Worker* by_process(WorkerProcessId process) const;
  /// Returns the displayed name of an instance; the instance itself if it is not known any more.
  std::string name_of(const std::string& instance) const;

  /// Adds a worker that is not known yet, under a displayed name that no other has. `name`: the
  /// reported name.
  Worker& add(const std::string& instance, const std::string& name, bool browser);
  /// Returns the number of connected browsers. Searches all workers: only for rare events.
  std::size_t connected_browsers() const;
  void connect(Worker& worker, SessionId session);
  /// Keeps the worker as one that has left. If more than kMaxGone workers that have left are
  /// kept, forgets those that left first.
  void disconnect(Worker& worker);

  std::map<WorkerId, Worker>& all() { return all_; }
  const std::map<WorkerId, Worker>& all() const { return all_; }
  std::size_t connected() const { return by_session_.size(); }

 private:
  /// Maximum number of workers that are kept after they have left. It bounds the memory. Those that
  /// left last are kept, since they may come back or be shown.
  static constexpr std::size_t kMaxGone = 512;
  void forget_gone();

  std::map<WorkerId, Worker> all_;
  std::map<std::string, WorkerId> by_instance_;
  std::map<SessionId, WorkerId> by_session_;
  std::map<std::string, WorkerId> by_name_;
  std::vector<WorkerId> gone_;  ///< workers that have left, in the order in which they left
  WorkerId next_ = 1;
};

/// Index of the workers that can take a lease, that is, of the workers with spare credits. Workers
/// with the fewest leases come first, so that the leases are spread over as many workers as
/// possible. Also counts the farm's threads.
class AvailableWorkers {
 public:
  /// Sort key: the number of leases that the worker holds, then its id.
  using Place = std::pair<std::size_t, WorkerId>;

  /// MUST be called after each change of a worker's leases, session or state.
  void update(const Worker& worker) {
    forget(worker.id);
    if (!worker.eligible()) {
      return;
    }
    threads_ += worker.threads;
    natives_ += worker.browser ? 0 : 1;
    Known& known = known_[worker.id];
    known.threads = worker.threads;
    known.browser = worker.browser;
    if (worker.has_spare_credit()) {
      known.place = {worker.leases.size(), worker.id};
      places_.insert(*known.place);
    }
  }

  /// Returns the first place after `place`, or the very first if `place` is std::nullopt.
  std::optional<Place> first_after(const std::optional<Place>& place) const {
    const auto it = place ? places_.upper_bound(*place) : places_.begin();
    return it == places_.end() ? std::nullopt : std::optional(*it);
  }

  bool contains(const Place& place) const { return places_.contains(place); }
  std::size_t size() const { return places_.size(); }
  /// Returns the number of eligible workers, with or without spare credits.
  std::size_t eligible() const { return known_.size(); }
  /// Returns the number of threads of all eligible workers.
  std::uint64_t threads() const { return threads_; }
  /// Returns the number of eligible workers that are not browsers.
  std::size_t natives() const { return natives_; }

 private:
  struct Known {
    std::uint32_t threads = 0;
    bool browser = false;
    std::optional<Place> place;
  };

  void forget(WorkerId id) {
    const auto it = known_.find(id);
    if (it == known_.end()) {
      return;
    }
    threads_ -= it->second.threads;
    natives_ -= it->second.browser ? 0 : 1;
    if (it->second.place) {
      places_.erase(*it->second.place);
    }
    known_.erase(it);
  }

  std::set<Place> places_;
  std::map<WorkerId, Known> known_;
  std::uint64_t threads_ = 0;
  std::size_t natives_ = 0;
};

}  // namespace bandsaw::coordinator
