// The table of leases, by id. A lease assigns a range of rows and samples of a job to a worker. An
// epoch is one run of the coordinator.

#include "coordinator/scheduler/context/leases.h"

#include "coordinator/scheduler/api/worker_process.h"
#include "coordinator/scheduler/model/coverage.h"

namespace bandsaw::coordinator {

// The first id has 24 bits that depend on the epoch, above 39 bits that count the leases. The
// highest of the 64 bits is 0.
Leases::Leases(const std::string& epoch)
    : next_(epoch.empty() ? 1 : ((text_hash(epoch) >> 40) << 39) + 1) {}

LeaseId Leases::new_id() {
  // The values kFree and kStored mark rows without a lease (coverage.h), so they are not used as
  // ids. Leases of an earlier epoch, which workers still hold after a restart, keep their ids. Such
  // an id may lie in the range of this epoch, so ids that are in use are skipped.
  while (next_ == kFree || next_ == kStored || all_.contains(next_)) {
    ++next_;
  }
  return next_++;
}

Lease* Leases::find(LeaseId id) {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

const Lease* Leases::find(LeaseId id) const {
  const auto it = all_.find(id);
  return it == all_.end() ? nullptr : &it->second;
}

}  // namespace bandsaw::coordinator
