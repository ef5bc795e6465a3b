// Renders an image band by band. A pass renders one range of samples for all rows. The range is a
// node of the tree by which samples are added up: an aligned range of a power-of-two number of
// blocks of 8 samples (band.h).

#include "renderlib/render/render_image.h"

#include <algorithm>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "renderlib/base/status_macros.h"
#include "renderlib/render/render_band.h"

namespace bandsaw {

std::vector<SampleRange> passes_of(std::uint64_t samples) {
  std::vector<SampleRange> passes;
  std::vector<SampleRange> nodes = maximal_nodes(samples);
  if (nodes.empty()) {
    return passes;
  }
  // The first node is halved again and again, until one block is left. Each right half is a pass,
  // and the remaining block is the first pass. These passes are collected from the last to the
  // first.
  SampleRange left = nodes.front();
  while (left.blocks() > 1) {
    const Halves halves = split(left);
    passes.push_back(halves.right);
    left = halves.left;
  }
  passes.push_back(left);
  std::reverse(passes.begin(), passes.end());
  // Each further node is a pass of its own.
  passes.insert(passes.end(), nodes.begin() + 1, nodes.end());
  return passes;
}

std::vector<Band> bands_of(std::uint64_t samples, const RowRange& rows, std::uint32_t width) {
  const auto most_rows =
      static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kBandPixels / std::max(1u, width)));
  std::vector<Band> bands;
  for (const SampleRange& pass : passes_of(samples)) {
    for (std::uint32_t first = rows.first; first < rows.last;) {
      const std::uint32_t last = first + std::min(most_rows, rows.last - first);
      bands.push_back({pass, {first, last}});
      first = last;
    }
  }
  return bands;
}

absl::Status render_rows(const Scene& scene, const RenderSettings& settings, std::uint64_t samples,
                         const RowRange& rows, Pool& pool, const std::atomic<bool>& stop,
                         const SamplesDone& progress,
                         absl::FunctionRef<absl::Status(const BandPixels&)> take) {
  RETURN_IF_ERROR(validate(settings));
  if (samples < 1 || samples > kMaxSamples) {
    return absl::InvalidArgumentError(
        absl::StrCat("samples: must be in [1, ", kMaxSamples, "], is ", samples));
  }
  if (rows.first >= rows.last || rows.last > settings.height) {
    return absl::InvalidArgumentError(absl::StrCat("rows: must be a range within [0, ",
                                                   settings.height, "), are [", rows.first, ", ",
                                                   rows.last, ")"));
  }
  std::uint64_t done = 0;
  for (const Band& band : bands_of(samples, rows, settings.width)) {
    const std::uint64_t row_samples = settings.width * band.samples.samples();
    const RowsDone rows_done = [&, done](std::uint32_t count) {
      if (progress) {
        progress(done + count * row_samples);
      }
    };
    ASSIGN_OR_RETURN(const BandPixels pixels,
                     render_band(scene, settings, band, pool, stop, rows_done));
    RETURN_IF_ERROR(take(pixels));
    done += band.rows.count() * row_samples;
  }
  return absl::OkStatus();
}

absl::StatusOr<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                           std::uint64_t samples, Pool& pool,
                                           const std::atomic<bool>& stop,
                                           const SamplesDone& progress,
                                           const std::string& spill_folder) {
  ASSIGN_OR_RETURN(Film film, Film::create(settings.width, settings.height, spill_folder));
  RenderedImage rendered{std::move(film), {}};
  const auto add = [&](const BandPixels& pixels) {
    rendered.counters.add(pixels.counters);
    return rendered.film.add(pixels);
  };
  RETURN_IF_ERROR(
      render_rows(scene, settings, samples, {0, settings.height}, pool, stop, progress, add));
  return rendered;
}

}  // namespace bandsaw
