#pragma once

// Plans the passes of a render on this machine: the counterpart of the coordinator's scheduler, for
// one image and one stop rule.

#include <deque>
#include <optional>

#include "absl/functional/function_ref.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {

class LocalPlan {
 public:
  /// `grid`: tiles of the image; used by adaptive stop rules only.
  explicit LocalPlan(const StopRule& stop, const TileGrid& grid = {}) : stop_(stop), grid_(grid) {}

  /// Returns the next pass, after samples [0, samples) were rendered in `seconds`. `error` is their
  /// estimated relative RMSE, negative if unknown. Returns std::nullopt if the image is done.
  std::optional<SampleRange> next(std::uint64_t samples, double error, double seconds);
  /// Returns the end of the last planned pass.
  std::uint64_t planned() const { return planned_; }

  /// Returns true if the image may be done: the next call of next() decides by the error.
  bool wants_error() const { return passes_.empty() && std::holds_alternative<StopAtError>(stop_); }
  /// Returns true if the tiles are to be planned now, before the call of next() with the same
  /// error.
  bool wants_tiles(double error) const;
  /// Plans the samples of the half tiles from their errors after samples [0, samples).
  void plan(absl::Span<const HalfTileErrors> tiles, std::uint64_t samples);
  /// Returns the samples of half tiles in the pass returned by next(). Must be called once per
  /// pass.
  TileSamples tiles(const SampleRange& pass) {
    return schedule_ ? schedule_->next(pass) : TileSamples();
  }

 private:
  std::optional<SampleRange> first_of(std::uint64_t from, std::uint64_t to);

  StopRule stop_;
  TileGrid grid_;
  std::optional<TileSchedule> schedule_;
  std::deque<SampleRange> passes_;  ///< planned, not started
  std::uint64_t planned_ = 0;
};

}  // namespace bandsaw::coordinator
