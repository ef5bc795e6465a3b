#pragma once

// Who can take a lease: the workers with spare credits, those with the fewest leases first, so that
// little work is spread over many. Also how many threads the whole farm has.

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "coordinator/core/workers.h"

namespace bandsaw::coordinator {

class Hunger {
 public:
  /// Leases held, worker.
  using Place = std::pair<std::size_t, WorkerId>;

  /// MUST be called after each change of a worker's leases, session or state.
  void update(const Worker& worker) {
    forget(worker.id);
    if (!worker.eligible()) {
      return;
    }
    threads_ += worker.threads;
    Known& known = known_[worker.id];
    known.threads = worker.threads;
    if (worker.hungry()) {
      known.place = {worker.leases.size(), worker.id};
      places_.insert(*known.place);
    }
  }

  /// The first place, or the first after another.
  std::optional<Place> first_after(const std::optional<Place>& place) const {
    const auto it = place ? places_.upper_bound(*place) : places_.begin();
    return it == places_.end() ? std::nullopt : std::optional(*it);
  }

  bool contains(const Place& place) const { return places_.contains(place); }
  std::size_t size() const { return places_.size(); }
  std::size_t eligible() const { return known_.size(); }
  std::uint64_t threads() const { return threads_; }

 private:
  struct Known {
    std::uint32_t threads = 0;
    std::optional<Place> place;
  };

  void forget(WorkerId id) {
    const auto it = known_.find(id);
    if (it == known_.end()) {
      return;
    }
    threads_ -= it->second.threads;
    if (it->second.place) {
      places_.erase(*it->second.place);
    }
    known_.erase(it);
  }

  std::set<Place> places_;
  std::map<WorkerId, Known> known_;
  std::uint64_t threads_ = 0;
};

}  // namespace bandsaw::coordinator
