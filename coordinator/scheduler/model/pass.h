#pragma once

// One pass of a job (a range of samples of the whole image): its stored rows, and the worker
// processes that rendered them.

#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "coordinator/scheduler/api/ids.h"
#include "coordinator/scheduler/model/coverage.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_samples.h"

namespace bandsaw::coordinator {

/// Sums over the stored bands of a pass or of a job. Each row is counted once, with the first valid
/// result.
struct Totals {
  std::uint64_t samples = 0;  ///< pixel samples
  Counters counters;
  double cpu_s = 0;

  void add(const Totals& other) {
    samples += other.samples;
    counters.add(other.counters);
    cpu_s += other.cpu_s;
  }
};

/// Digests (hashes of the pixel sums) of the stored rows of one pass. A second result for the same
/// samples is compared with the digests.
class RowDigests {
 public:
  /// Keeps the digests of `rows`. `digests`: one for each row of the band.
  void keep(const Band& band, const std::vector<RowRange>& rows,
            const std::vector<std::uint64_t>& digests);

  /// Compares `digests` (one for each row of the band) with the known digests of exactly the band's
  /// samples. Returns the first row whose two digests differ; std::nullopt: there is none.
  std::optional<std::uint32_t> first_difference(const Band& band,
                                                const std::vector<std::uint64_t>& digests) const;

  /// Returns the digest of a row over these samples; std::nullopt: unknown.
  std::optional<std::uint64_t> of(const SampleRange& samples, std::uint32_t row) const;
  /// Forgets the digests of exactly the band's samples in the band's rows.
  void forget(const Band& band);
  void clear() { known_.clear(); }

 private:
  std::map<SampleRange, std::map<std::uint32_t, std::uint64_t>> known_;
};

struct Pass {
  SampleRange samples;
  Coverage coverage;  ///< who owns each sample of each row
  /// Samples that each half tile (half of the pixels of a 16 x 16 tile) of the image takes.
  TileSamples tiles;
  /// For each tile row, the number of samples that its pixels take, divided by the number that they
  /// would take with uniform sampling; empty: 1 for each.
  std::vector<float> tile_row_shares;
  Totals stored;
  RowDigests digests;
  /// Consecutive rows that were stored with one result.
  struct StoredBand {
    Band band;
    /// If a result has several StoredBands, the first has the totals of the whole result, and the
    /// others have 0.
    Totals totals;
  };
  /// All bands of the pass that one worker process stored.
  struct Part {
    std::vector<StoredBand> bands;
    Totals totals;  ///< sums over all bands
  };
  std::map<WorkerProcessId, Part> parts;
  /// For logs: the number of leases that were given back unfinished. The key is the first sample
  /// and the first row of their band.
  std::map<std::pair<std::uint64_t, std::uint32_t>, std::uint32_t> returned;

  double mean_share() const;  ///< mean of tile_row_shares
  /// Returns the samples that the half tiles of the band take.
  TileSamples tiles_of(const Band& band) const { return tiles.of(samples, band); }
  /// Counts these rows of a band as stored by a worker process. `totals`: the totals of all these
  /// rows.
  void add_stored(WorkerProcessId process, const Band& band, const std::vector<RowRange>& rows,
                  const Totals& totals);
  /// Frees everything that the process stored, so that it is rendered again. Returns false if it
  /// had stored nothing.
  bool retract(WorkerProcessId process);
  /// Returns true if the process stored exactly this band and it was not freed since.
  bool has_stored(const Band& band, WorkerProcessId process) const;
  /// Frees a band for which has_stored() is true and returns its totals. Otherwise does nothing and
  /// returns std::nullopt.
  std::optional<Totals> remove_stored(const Band& band, WorkerProcessId process);
  /// Returns the process that stored a row with exactly these samples; 0: unknown.
  WorkerProcessId process_of_row(const SampleRange& samples, std::uint32_t row) const;

 private:
  void recompute_totals();
};

}  // namespace bandsaw::coordinator
