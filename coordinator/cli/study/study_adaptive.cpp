// render_adaptively() first renders a pilot, in which every pixel gets the same number of samples.
// From the errors of the pilot, the function plans how many samples each half tile gets (half of
// the pixels of a square of 16 x 16). Then it renders passes until the mean number of samples per
// pixel is as requested.

#include "coordinator/cli/study/study_adaptive.h"

#include <algorithm>
#include <utility>

#include "coordinator/scheduler/model/pass_plan.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_band.h"
#include "renderlib/render/render_image.h"
#include "renderlib/render/tile_schedule.h"

namespace bandsaw::coordinator {
namespace {

/// The image as it forms: the film (sums of all pixels), the number of samples and of rays.
class AdaptiveRender {
 public:
  AdaptiveRender(const Scene& scene, const RenderSettings& settings, Pool& pool,
                 const std::atomic<bool>& stop, Film film)
      : scene_(scene), settings_(settings), pool_(pool), stop_(stop), film_(std::move(film)) {}

  /// Renders a range of samples of the whole image and adds it to the film, some rows at a time.
  /// `tiles`: the samples of each half tile; empty: all pixels take all samples of the range.
  absl::Status take(const SampleRange& pass, const TileSamples& tiles) {
    const auto most =
        static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kBandPixels / settings_.width));
    for (RowRange rows{0, 0}; rows.last < settings_.height; rows.first = rows.last) {
      rows.last = rows.first + std::min(most, settings_.height - rows.first);
      ASSIGN_OR_RETURN(const BandPixels pixels, render_band(scene_, settings_, {pass, rows}, pool_,
                                                            stop_, /*progress=*/{}, tiles));
      out_.rays += static_cast<double>(pixels.counters.rays);
      RETURN_IF_ERROR(film_.add(pixels, tiles));
    }
    const RowRange all{0, settings_.height};
    out_.samples += static_cast<double>(tiles.count(settings_.width, {pass, all})) /
                    (static_cast<double>(settings_.width) * settings_.height);
    return absl::OkStatus();
  }
  /// Returns the mean number of samples per pixel so far.
  double samples() const { return out_.samples; }
  const Film& film() const { return film_; }
  AdaptiveImage result() {
    out_.image = film_.snapshot().image;
    return std::move(out_);
  }

 private:
  const Scene& scene_;
  const RenderSettings& settings_;
  Pool& pool_;
  const std::atomic<bool>& stop_;
  Film film_;
  AdaptiveImage out_;
};

}  // namespace

absl::StatusOr<AdaptiveImage> render_adaptively(const Scene& scene, const RenderSettings& settings,
                                                std::uint64_t samples, Pool& pool,
                                                const std::atomic<bool>& stop) {
  const TileGrid grid{settings.width, settings.height};
  ASSIGN_OR_RETURN(Film film, Film::create(grid.width, grid.height, /*spill_folder=*/"",
                                           Film::Grain::kHalfTiles));
  AdaptiveRender render(scene, settings, pool, stop, std::move(film));
  const std::uint64_t sixteenth = samples / 16 / kBlockSamples * kBlockSamples;
  const std::uint64_t pilot = std::min(samples, std::max(kMinCheckpoint, sixteenth));
  for (const SampleRange& pass : passes_between(0, pilot)) {
    RETURN_IF_ERROR(render.take(pass, /*tiles=*/{}));
  }
  if (pilot == samples) {
    return render.result();
  }
  TileSchedule schedule(grid, plan_tiles(grid, render.film().tile_errors(), pilot));
  const auto wanted = static_cast<double>(samples);
  for (std::uint64_t at = pilot; render.samples() < wanted;) {
    const SampleRange pass = next_timed_pass(at, wanted - render.samples(), kMaxSamples);
    RETURN_IF_ERROR(render.take(pass, schedule.next(pass)));
    at = pass.last;
  }
  return render.result();
}

}  // namespace bandsaw::coordinator
