#pragma once

// Chooses the next band of a job for a worker: which free rows, and how many of them. A band is a
// range of rows and samples, the unit of work that is leased.
//
// The size follows guided self-scheduling (Polychronopoulos & Kuck 1987, "Guided Self-Scheduling: A
// Practical Scheduling Scheme for Parallel Supercomputers") with measured work rates and costs.
// Bands take about the target time while much work is left, and get shorter toward the end, so that
// all workers finish together. Work is counted in pixel samples, weighted with the relative costs
// of their rows (CostMap).

#include <cstdint>
#include <optional>

#include "coordinator/scheduler/context/context.h"
#include "coordinator/scheduler/dispatch/eligibility.h"

namespace bandsaw::coordinator {

/// The data on which the size of a band depends.
struct Sizing {
  Band free;                ///< the free piece; the band is cut from its first row
  std::uint32_t width = 0;  ///< pixels
  const CostMap* cost = nullptr;
  /// For each row of tiles, the number of samples that its pixels take, divided by the number that
  /// they would take with uniform sampling; empty: 1 for each.
  absl::Span<const float> tile_row_shares = {};
  double work_rate = 0;   ///< work per second of the worker on this job, > 0
  bool measured = false;  ///< false: the rate is a guess; the band is small, to measure it
  /// The worker's share of the farm's work rate, (0, 1]. Near the end of a job, a band gets half of
  /// this share of the work that is left, but not less than a minimum that depends on target_s. If
  /// the worker is the only one on the job, the share is set to 2, so that a band may get all of
  /// the work.
  double farm_share = 1;
  double work_left = 0;  ///< work of the job that is neither leased nor stored
  double target_s = 1;   ///< render time of a band, > 0
};

/// Returns a part of `free` that begins at its first row. It avoids dividing a row of tiles
/// (render/tile_samples.h) between two bands: if the pixels of a tile share paths
/// (render/pixel_groups.h), both bands would have to trace the whole tile. So a band ends at the
/// end of a row of tiles if it is long enough. If the first row of tiles alone takes more than two
/// target times, the band gets the whole row of tiles with fewer samples. Only if a single block of
/// 8 samples of this row of tiles still takes more than two target times, the band gets fewer rows.
Band size_band(const Sizing& sizing);

/// Returns the maximum number of rows of a band that fit into a message.
std::uint32_t max_rows(std::uint32_t width);

class BandChooser {
 public:
  BandChooser(const Context& context, const Eligibility& eligibility)
      : context_(context), eligibility_(eligibility) {}

  /// Returns the next probe (dispatch/probes.h), or else the first free band that is not left to
  /// other workers (Eligibility); std::nullopt: there is none for this worker. Counts the probes
  /// that it returns or skips (Job::probes).
  std::optional<Band> choose(Job& job, const Worker& worker) const;
  /// Returns the first free band that is not left to other workers, and never a probe.
  /// std::nullopt: there is none for this worker.
  std::optional<Band> choose_free(const Job& job, const Worker& worker) const;
  /// Returns the band that the worker should get from `free`, a free piece of the job. The band
  /// begins at the first row of `free`.
  Band sized(const Job& job, const Worker& worker, const Band& free) const;

 private:
  /// Returns the free rows of the next probe that this worker may take, and counts this probe and
  /// those that it skips. std::nullopt: no probe is left.
  std::optional<Band> next_probe(Job& job, const Worker& worker) const;
  /// Returns the first free piece of the job that is not left to other workers; it is not yet cut
  /// to the size of a band. std::nullopt: there is none for this worker.
  std::optional<Band> first_free(const Job& job, const Worker& worker) const;
  /// Returns the band that sized() returns, but changed so that suspect rows (rows that a worker
  /// held when it was lost) and other rows are never in one band.
  Band cut(const Job& job, const Worker& worker, const Band& free) const;

  const Context& context_;
  const Eligibility& eligibility_;
};

}  // namespace bandsaw::coordinator
