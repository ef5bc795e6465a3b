#pragma once

// Handles bands (ranges of rows and samples) whose pixels are on disk: counts them as stored, and
// frees the bands that are found damaged.

#include <cstdint>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/lease_ledger.h"

namespace bandsaw::coordinator {

class StoredBands {
 public:
  StoredBands(Context& context, LeaseLedger& ledger) : context_(context), ledger_(ledger) {}

  /// Counts the rows of the band that were not stored yet. Returns these rows, and the leases that
  /// lost rows to this result. REQUIRES one digest per row.
  Coverage::Change store(Job& job, Pass& pass, const input::BandStored& in,
                         const Reporter& reporter);
  /// Frees the damaged bands that are still counted as stored. A job that is finishing runs again,
  /// because its image could not be made without the damaged bands.
  void free_damaged(Job& job, const input::BandsDamaged& in);
  /// After a restart: journals which audited bands (whose result a second machine has confirmed)
  /// are missing from the band log, the file of the job's stored bands. The same process may render
  /// such a band again, and the new result must be audited too.
  void note_missing_audited(const Job& job);

 private:
  void add_share(Job& job, const input::BandStored& in, WorkerProcessId process,
                 std::uint64_t samples);
  void close_audits(Job& job, const Band& band, WorkerProcessId process);

  Context& context_;
  LeaseLedger& ledger_;
};

}  // namespace bandsaw::coordinator
