#pragma once

// How much one worker is given at a time: guided self-scheduling (Polychronopoulos & Kuck 1987,
// "Guided Self-Scheduling: A Practical Scheduling Scheme for Parallel Supercomputers") by measured
// speed and measured cost. Bands take about the target time while much is left and get shorter
// toward the end, so that all workers finish together.
//
// Work is counted in pixel samples of cost 1 (cost_map.h).

#include <cstdint>

#include "coordinator/core/cost_map.h"
#include "coordinator/core/types.h"

namespace bandsaw::coordinator {

/// A worker's pace before anything is measured, in work a second and thread: rather too low, since
/// a first band that is too small costs little and one that is too large delays the first rows.
inline constexpr double kGuessedRate = 100'000;

struct Sizing {
  Band free;                ///< what may be cut from, from its top left
  std::uint32_t width = 0;  ///< pixels
  const CostMap* cost = nullptr;
  absl::Span<const float> shares = {};  ///< of each tile row, as cost_map.h takes them
  double pace = 0;                      ///< work a second of this worker on this job, > 0
  bool measured = false;                ///< else the band is small, to show rows and to measure
  double share = 1;                     ///< of the farm's pace that is this worker's, (0, 1]
  double left = 0;                      ///< work of the job that nobody has yet
  double target_s = 1;                  ///< > 0
};

/// A piece of `free`: whole rows of all its samples, or, when one row alone takes more than two
/// targets, a part of the samples of one row.
Band size_band(const Sizing& sizing);

/// The most rows of a band that fit into a message.
std::uint32_t most_rows(std::uint32_t width);

}  // namespace bandsaw::coordinator
