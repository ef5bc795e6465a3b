// Renders an image in passes. Each pass is rendered in bands (some rows each), which are added to a
// film. The film has the sums of all pixels. LocalPlan decides after each pass whether another one
// follows.

#include "coordinator/cli/render/local_render.h"

#include <algorithm>
#include <utility>

#include "absl/functional/function_ref.h"
#include "coordinator/cli/base/cpu_time.h"
#include "coordinator/cli/render/local_plan.h"
#include "coordinator/engine/clock.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_band.h"
#include "renderlib/render/render_image.h"

namespace bandsaw::coordinator {
namespace {

// Renders the samples `pass` of the rows `rows` in bands, and calls `take` with each band. `tiles`:
// how many samples each half tile takes; empty: all pixels take all samples. A half tile has half
// of the pixels of a square of 16 x 16. `done`: the number of samples rendered so far, summed over
// all pixels; the samples of this pass are added to `done`.
absl::Status render_pass(const LocalJob& job, const SampleRange& pass, const RowRange& rows,
                         const TileSamples& tiles, std::uint64_t& done,
                         absl::FunctionRef<absl::Status(BandPixels)> take) {
  const auto most =
      static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kBandPixels / job.settings.width));
  for (RowRange part{rows.first, rows.first}; part.last < rows.last; part.first = part.last) {
    part.last = part.first + std::min(most, rows.last - part.first);
    const std::uint64_t samples = tiles.count(job.settings.width, {pass, part});
    const auto advanced = [&job, &part, done, samples](std::uint32_t count) {
      job.meter.reached(done + samples * count / part.count());
    };
    ASSIGN_OR_RETURN(BandPixels pixels, render_band(job.scene, job.settings, {pass, part}, job.pool,
                                                    job.stop, advanced, tiles));
    done += samples;
    job.meter.add(pixels.counters);
    RETURN_IF_ERROR(take(std::move(pixels)));
  }
  return absl::OkStatus();
}

}  // namespace

LocalMeter::Clocks clocks() { return {steady_seconds(), process_cpu_seconds()}; }

absl::StatusOr<Film> render_whole(const LocalJob& job, const StopRule& stop) {
  ASSIGN_OR_RETURN(Film film,
                   Film::create(job.settings.width, job.settings.height, /*spill_folder=*/"",
                                is_adaptive(stop) ? Film::Grain::kHalfTiles : Film::Grain::kRows));
  LocalPlan plan(stop, {job.settings.width, job.settings.height});
  std::uint64_t done = 0;
  std::uint64_t samples = 0;
  double error = -1;
  while (const auto pass = plan.next(samples, error, job.meter.seconds(steady_seconds()))) {
    job.meter.plans(plan.planned());
    const TileSamples tiles = plan.tiles(*pass);
    RETURN_IF_ERROR(render_pass(job, *pass, {0, job.settings.height}, tiles, done,
                                [&](const BandPixels& pixels) {
                                  const absl::Status added = film.add(pixels, tiles);
                                  if (added.ok() && job.grown) {
                                    job.grown(film);
                                  }
                                  return added;
                                }));
    samples = pass->last;
    const auto estimate = film.error();
    error = known_error(estimate, samples);
    job.meter.passed(samples, estimate, clocks());
    if (job.error_of && error >= 0 && plan.wants_error()) {
      ASSIGN_OR_RETURN(error, job.error_of(film, samples));
      job.meter.measured(samples, error);
    }
    if (plan.wants_tiles(error)) {
      plan.plan(film.tile_errors(), samples);
    }
  }
  return film;
}

absl::StatusOr<std::vector<BandPixels>> render_part(const LocalJob& job, const RowRange& rows,
                                                    std::uint64_t samples) {
  std::vector<BandPixels> bands;
  std::vector<SampleRange> nodes = maximal_nodes(samples);
  if (nodes.front().blocks() > 1) {
    // The samples of a pixel are added in a binary tree, whose nodes are ranges of samples.
    // `bandsaw stitch` estimates the error of the whole image from the two halves of the first
    // node, as `render` does without --rows. So the halves are kept apart.
    const Halves halves = split(nodes.front());
    nodes.front() = halves.right;
    nodes.insert(nodes.begin(), halves.left);
  }
  std::uint64_t done = 0;
  for (const SampleRange& node : nodes) {
    RETURN_IF_ERROR(render_pass(job, node, rows, /*tiles=*/{}, done, [&](BandPixels pixels) {
      bands.push_back(std::move(pixels));
      return absl::OkStatus();
    }));
  }
  job.meter.passed(samples, std::nullopt, clocks());
  return bands;
}

absl::StatusOr<Image> image_of_part(const std::vector<BandPixels>& bands,
                                    const RenderSettings& settings, const RowRange& rows) {
  ASSIGN_OR_RETURN(Film film, Film::create(settings.width, settings.height, /*spill_folder=*/""));
  for (const BandPixels& band : bands) {
    RETURN_IF_ERROR(film.add(band));
  }
  const Image whole = film.snapshot().image;
  Image part{.width = whole.width, .height = rows.count(), .pixels = {}};
  const auto at = [&](std::uint32_t row) {
    return whole.pixels.begin() + static_cast<std::ptrdiff_t>(std::size_t{row} * whole.width);
  };
  part.pixels.assign(at(rows.first), at(rows.last));
  return part;
}

}  // namespace bandsaw::coordinator
