#pragma once

// The passes of a render on this machine: what the coordinator's core does for a farm, for one
// image and one stop rule.

#include <deque>
#include <optional>

#include "absl/functional/function_ref.h"
#include "coordinator/core/types.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {

class LocalPlan {
 public:
  /// `grid`: of the image; asked of adaptive stop rules only.
  explicit LocalPlan(const StopRule& stop, const TileGrid& grid = {}) : stop_(stop), grid_(grid) {}

  /// The next pass, after samples [0, samples) were rendered in `seconds`; `error` is their
  /// estimated relative RMSE, negative when it is not known. Nothing: the image is done.
  std::optional<SampleRange> next(std::uint64_t samples, double error, double seconds);
  /// Where the last planned pass ends.
  std::uint64_t planned() const { return planned_; }

  /// Whether the tiles are to be planned now, before next() is asked with the same error.
  bool wants_tiles(double error) const;
  void plan(absl::Span<const HalfTileErrors> tiles, std::uint64_t samples);
  /// What half tiles take in the pass that next() gave. Once for each.
  TileSamples tiles(const SampleRange& pass) {
    return schedule_ ? schedule_->next(pass) : TileSamples();
  }

 private:
  std::optional<SampleRange> first_of(std::uint64_t from, std::uint64_t to);

  StopRule stop_;
  TileGrid grid_;
  std::optional<TileSchedule> schedule_;
  std::deque<SampleRange> passes_;  ///< planned, not begun
  std::uint64_t planned_ = 0;
};

}  // namespace bandsaw::coordinator
