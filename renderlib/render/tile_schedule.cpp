// Decides in each pass which half tiles (the units of adaptive sampling) take their next node. A
// node is an aligned range of 2^k blocks of 8 samples. A half tile takes its next node if it is
// behind the plan by more samples than a threshold. The threshold differs between half tiles, so
// that not all of them take a node in the same pass.

#include "renderlib/render/tile_schedule.h"

#include <algorithm>
#include <bit>

#include "renderlib/base/check.h"

namespace bandsaw {
namespace {

/// Returns a number in [0, 1) for half tile i. The numbers are the fractions of the multiples of
/// the golden ratio (2654435769 / 2^32), so they are evenly distributed over neighbours and over
/// any range of i.
double spread(std::size_t i) {
  return static_cast<std::uint32_t>(i * 2'654'435'769u) / 4'294'967'296.0;
}

/// Returns the number of samples of the next node of a half tile that has `samples` samples, which
/// are whole blocks. `owed` is the number of samples by which the half tile is behind the plan. The
/// node is the longest node that may begin after `samples`, up to a limit. The limit is the largest
/// of three numbers: one block, a quarter of the largest power of two up to `samples`, and the
/// largest power of two up to `owed`.
std::uint64_t next_step(std::uint64_t samples, double owed) {
  const std::uint64_t aligned = longest_at(samples / kBlockSamples) * kBlockSamples;
  const std::uint64_t quarter = std::bit_floor(samples) / 4;
  return std::min(aligned, std::max({kBlockSamples, quarter,
                                     std::bit_floor(static_cast<std::uint64_t>(owed))}));
}

}  // namespace

TileSchedule::TileSchedule(const TileGrid& grid, const TilePlan& plan)
    : grid_(grid), plan_(plan), taken_(grid.half_tiles(), static_cast<std::uint32_t>(plan.pilot)) {
  BANDSAW_CHECK(plan.levels.size() == grid.half_tiles(), "one level a half tile");
  for (std::size_t i = 0; i < plan.levels.size(); ++i) {
    uniform_[i % 2] = uniform_[i % 2] && plan.levels[i] == kEvenLevel;
  }
}

TileSamples TileSchedule::next(const SampleRange& pass) {
  if (uniform_[0] && uniform_[1]) {
    return {};
  }
  TileSamples tiles(grid_.width, {0, grid_.height});
  for (std::size_t i = 0; i < taken_.size(); ++i) {
    const SampleRange samples = uniform_[i % 2] ? pass : node_of(i, pass);
    if (samples.samples() > 0) {
      taken_[i] = samples.last;
      tiles.set(i, samples);
    }
  }
  return tiles;
}

SampleRange TileSchedule::node_of(std::size_t i, const SampleRange& pass) const {
  const std::uint64_t at = taken_[i];
  const double due = share_of(plan_, i) * static_cast<double>(pass.last);
  const double owed = std::max(0.0, due - static_cast<double>(at));
  const std::uint64_t step = next_step(at, owed);
  if (owed <= static_cast<double>(step) * spread(i) || at + step > kMaxSamples) {
    return {};
  }
  return {at, at + step};
}

}  // namespace bandsaw
