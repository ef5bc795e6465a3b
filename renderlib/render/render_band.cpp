#include <algorithm>
#include <atomic>
#include <vector>

#include "renderlib/base/status_macros.h"
#include "renderlib/render/kernel_code.h"
#include "renderlib/render/pixel_sums.h"

namespace bandsaw {
namespace {

/// One unit of work takes about this many samples: a few milliseconds, so that all threads end
/// together.
constexpr std::uint64_t kSamplesPerUnit = 1024;

/// Partition of a band's pixels among threads: runs of neighbours in a row, whose rays use the same
/// cached data.
struct Units {
  Units(const Band& band, std::uint32_t width, std::uint32_t step)
      : run(static_cast<std::uint32_t>(
            std::clamp<std::uint64_t>(kSamplesPerUnit / band.samples.samples() / step, 1,
                                      (width + step - 1) / step) *
            step)),
        per_row((width + run - 1) / run),
        count(std::int64_t{per_row} * band.rows.count()) {}

  std::uint32_t run;      ///< pixels
  std::uint32_t per_row;  ///< runs
  std::int64_t count;
};

}  // namespace

absl::StatusOr<BandPixels> render_band_with_kernel(const Scene& scene,
                                                   const RenderSettings& settings, const Band& band,
                                                   Pool& pool, const std::atomic<bool>& stop,
                                                   const RowsDone& progress,
                                                   const TileSamples& tiles) {
  RETURN_IF_ERROR(validate(band, settings));
  const PixelSums pixel_sums(scene, settings, band, stop);
  const Units units(band, settings.width, pixel_sums.run_step());
  BandPixels pixels{
      .band = band,
      .width = settings.width,
      .sums = std::vector<double>(std::size_t{band.rows.count()} * settings.width * 3),
      .counters = {.dropped_primitives = scene.dropped_primitives()}};
  std::vector<Counters> counters(static_cast<std::size_t>(units.count));
  std::vector<std::atomic<std::uint32_t>> runs_done(band.rows.count());
  std::atomic<std::uint32_t> rows_done = 0;

  pool.parallel_for(units.count, [&](std::int64_t unit) {
    const auto row = static_cast<std::uint32_t>(unit / units.per_row);
    const auto first = static_cast<std::uint32_t>(unit % units.per_row) * units.run;
    const std::uint32_t last = std::min(first + units.run, settings.width);
    const std::size_t row_size = std::size_t{settings.width} * 3;
    Counters of_unit;
    pixel_sums.add_run(band.rows.first + row, first, last, tiles,
                       absl::MakeSpan(pixels.sums).subspan(row * row_size, row_size), of_unit);
    if (pixel_sums.stopped()) {
      return;
    }
    counters[static_cast<std::size_t>(unit)] = of_unit;
    if (++runs_done[row] == units.per_row && progress) {
      progress(++rows_done);
    }
  });

  if (pixel_sums.stopped()) {
    return absl::CancelledError("the render was stopped");
  }
  for (const Counters& of_unit : counters) {
    pixels.counters.add(of_unit);
  }
  return pixels;
}

}  // namespace bandsaw
