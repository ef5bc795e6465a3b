#pragma once

// Renders a whole image, or some of its rows, on this machine, band by band as a farm would
// distribute it. Commands that render without a farm use it.

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

/// Returns the passes that make up samples [0, samples). A pass renders one range of samples for
/// all rows. The range is a node: an aligned range of a power-of-two number of blocks of 8 samples
/// (band.h). The first passes have one block, one block, two blocks, four blocks, and so on. So
/// each pass after the first doubles the number of samples and leaves two halves for the error
/// estimate. If fewer samples are left than a doubling needs, they are divided into the largest
/// possible nodes, and each of these nodes is one of the last passes.
std::vector<SampleRange> passes_of(std::uint64_t samples);

/// Divides `rows` into bands for each pass of passes_of(samples). Returns the bands pass by pass,
/// and the bands of a pass from the top. A band has at most kBandPixels pixels, or one row if a row
/// has more pixels.
std::vector<Band> bands_of(std::uint64_t samples, const RowRange& rows, std::uint32_t width);
inline constexpr std::uint64_t kBandPixels = std::uint64_t{1} << 20;

/// Called from pool threads with the number of samples (over all pixels) done so far, possibly out
/// of order; MUST be fast and thread-safe.
using SamplesDone = std::function<void(std::uint64_t)>;

/// Renders samples [0, samples) of `rows` and passes each finished band to `take`. Returns the
/// errors of render_band, or the first error that `take` returns.
absl::Status render_rows(const Scene& scene, const RenderSettings& settings, std::uint64_t samples,
                         const RowRange& rows, Pool& pool, const std::atomic<bool>& stop,
                         const SamplesDone& progress,
                         absl::FunctionRef<absl::Status(const BandPixels&)> take);

/// Result of render_image().
struct RenderedImage {
  Film film;
  Counters counters;
};

/// Renders the whole image. `spill_folder` is the folder of the files that hold the film's sums;
/// empty: the sums are in anonymous memory.
absl::StatusOr<RenderedImage> render_image(const Scene& scene, const RenderSettings& settings,
                                           std::uint64_t samples, Pool& pool,
                                           const std::atomic<bool>& stop,
                                           const SamplesDone& progress,
                                           const std::string& spill_folder);

}  // namespace bandsaw
