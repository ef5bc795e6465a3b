#pragma once

// Plans the passes of a render on this machine (`bandsaw render`). It divides an image as the
// coordinator's scheduler divides a job. A pass is a range of samples of the whole image.

#include <deque>
#include <optional>

#include "absl/functional/function_ref.h"
#include "coordinator/scheduler/api/job_spec.h"
#include "renderlib/render/band.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {

/// The plan of one render. In an adaptive render, parts of the image with more noise take more
/// samples, and the plan also says how many samples each half tile takes. A half tile has half of
/// the pixels of a square of 16 x 16. For each pass, the caller calls next() and tiles(), and
/// renders the pass. Then it calls plan() if wants_tiles() returns true.
class LocalPlan {
 public:
  /// `grid`: the size of the image; only adaptive stop rules need it.
  explicit LocalPlan(const StopRule& stop, const TileGrid& grid = {}) : stop_(stop), grid_(grid) {}

  /// Returns the next pass, after samples [0, samples) of all pixels were rendered in `seconds`.
  /// `error` is the estimated relative RMSE of the image, negative if unknown. Returns std::nullopt
  /// if the image is done.
  std::optional<SampleRange> next(std::uint64_t samples, double error, double seconds);
  /// Returns the end of the last planned pass, in samples per pixel.
  std::uint64_t planned() const { return planned_; }

  /// Returns true if the next call of next() decides by the error whether the image is done.
  bool wants_error() const { return passes_.empty() && std::holds_alternative<StopAtError>(stop_); }
  /// Returns true if plan() is to be called now, before next() is called with the same error. This
  /// happens at most once in an adaptive render.
  bool wants_tiles(double error) const;
  /// Plans the samples of the half tiles. `tiles`: their errors after samples [0, samples).
  void plan(absl::Span<const HalfTileErrors> tiles, std::uint64_t samples);
  /// Returns the samples of the half tiles in the pass that next() has returned; before plan() was
  /// called, all pixels take all samples of the pass. MUST be called once for each pass.
  TileSamples tiles(const SampleRange& pass) {
    return schedule_ ? schedule_->next(pass) : TileSamples();
  }

 private:
  /// Removes the first planned pass and returns it. If no pass is planned, plans the passes for
  /// samples [from, to) before that.
  std::optional<SampleRange> take_pass(std::uint64_t from, std::uint64_t to);

  StopRule stop_;
  TileGrid grid_;
  std::optional<TileSchedule> schedule_;  ///< std::nullopt: the half tiles are not planned
  std::deque<SampleRange> passes_;        ///< planned passes that next() has not returned yet
  std::uint64_t planned_ = 0;
};

}  // namespace bandsaw::coordinator
