#pragma once

// The bands that workers have in hand.

#include <cstdint>
#include <map>

#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// Of one worker process, over its reconnects; never used again in this life.
using WorkerId = std::uint64_t;

struct Lease {
  LeaseId id = 0;
  JobId job = 0;
  WorkerId worker = 0;
  Band band;
  /// A copy: this lease's band is a part of that one's, which goes on and owns the rows. 0: it owns
  /// its rows itself.
  LeaseId copy_of = 0;
  bool audit = false;     ///< its rows are stored: it owns none (audit.h)
  bool taken_up = false;  ///< named in a Hello: its result may come before the answer to that
  std::uint32_t rows_done = 0;
  std::uint64_t prepared = 0;
  Time told_at = 0;   ///< wall clock: when rows_done grew
  Time begun_at = 0;  ///< wall clock: when it became the first of its worker's
  Time advanced_at =
      0;  ///< patience clock: when it, or one that its worker renders before it, last advanced
};

class Leases {
 public:
  /// Ids begin where those of other lives are most unlikely to be, since leases of other lives are
  /// adopted with their ids.
  explicit Leases(const std::string& epoch);

  LeaseId new_id();
  Lease& add(const Lease& lease) { return all_.emplace(lease.id, lease).first->second; }
  void erase(LeaseId id) { all_.erase(id); }
  Lease* find(LeaseId id);
  const Lease* find(LeaseId id) const;
  const std::map<LeaseId, Lease>& all() const { return all_; }

 private:
  std::map<LeaseId, Lease> all_;
  LeaseId next_;
};

}  // namespace bandsaw::coordinator
