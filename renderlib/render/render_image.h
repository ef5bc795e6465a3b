#pragma once

// A whole image, or some of its rows, on this machine: the bands that a farm would deal out, one
// after the other.

#include <atomic>
#include <functional>
#include <vector>

#include "absl/functional/function_ref.h"
#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/band.h"
#include "renderlib/render/film.h"
#include "renderlib/render/settings.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The passes that give samples [0, samples): one block, one block, two, four, … so that each
/// doubles what is there and leaves two halves to estimate the error from; then the rest, node by
/// node.
std::vector<SampleRange> passes_of(std::uint64_t samples);

/// The bands of these passes over `rows`, pass by pass, from the top; each holds at most
/// kBandPixels pixels, or one row.
std::vector<Band> bands_of(std::uint64_t samples, const RowRange& rows, std::uint32_t width);
inline constexpr std::uint64_t kBandPixels = std::uint64_t{1} << 20;

/// Called from pool threads with the samples (of all pixels) that are done so far: quick and
/// thread-safe; possibly out of order.
using SamplesDone = std::function<void(std::uint64_t)>;

/// Renders samples [0, samples) of `rows` and hands over each band as it is done. Errors: as
/// render_band, or the first one that `take` returns.
absl::Status render_rows(const Scene& scene, const RenderSettings& settings, std::uint64_t samples,
                         const RowRange& rows, Pool& pool, const std::atomic<bool>& stop,
                         const SamplesDone& progress,
                         absl::FunctionRef<absl::Status(const BandPixels&)> take);

/// What a render gave.
struct RenderedImage {
  Film film;
  Counters counters;
};

/// Renders the whole image. `spill_folder`: as Film::create takes it.
absl::StatusOr<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                           std::uint64_t samples, Pool& pool,
                                           const std::atomic<bool>& stop,
                                           const SamplesDone& progress,
                                           const std::string& spill_folder);

}  // namespace bandsaw
