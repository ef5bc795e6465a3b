#pragma once

// The leases that workers hold. A lease assigns a band (a range of rows and samples of a job) to
// one worker. Leases are not journalled.

#include <cstdint>
#include <map>
#include <string>

#include "coordinator/scheduler/api/ids.h"
#include "renderlib/render/band.h"

namespace bandsaw::coordinator {

/// Identifies a worker process over its reconnects; never reused in an epoch.
using WorkerId = std::uint64_t;

struct Lease {
  LeaseId id = 0;
  JobId job = 0;
  WorkerId worker = 0;
  Band band;
  /// For a backup task: id of the original lease. The backup task renders a part of the original
  /// lease's band as well. The original lease goes on. It alone owns the rows: model/coverage.h
  /// records its id for them. 0: this is no backup task.
  LeaseId backup_of = 0;
  /// The lease is for an audit: stored rows are rendered again, to compare (model/audit.h). Such a
  /// lease owns no rows.
  bool audit = false;
  /// The worker named the lease in its Hello (its first message) when it reconnected. So it may
  /// send the result before it has read the coordinator's reply (LeaseLedger::end_rendered).
  bool in_hello = false;
  std::uint32_t rows_done = 0;  ///< rows that the worker reported as rendered
  std::uint64_t prepared = 0;   ///< grows while the worker fetches or builds the scene
  Time progress_at = 0;         ///< wall clock: when rows_done last grew
  Time begun_at = 0;            ///< wall clock: when it became the first lease of its worker
  /// Timeout clock (scheduler_clock.h): when this lease, or a lease that its worker renders before
  /// it, last made progress.
  Time advanced_at = 0;
};

class Leases {
 public:
  /// The first id depends on the epoch (one run of the coordinator), so that the ids of two epochs
  /// are different with high probability. That matters because a worker that reconnects after a
  /// restart may keep a lease of an earlier epoch, with its id.
  explicit Leases(const std::string& epoch);

  /// Returns an id that no lease has.
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
