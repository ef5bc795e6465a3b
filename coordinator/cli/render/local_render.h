#pragma once

// Renders an image, or some of its rows, on this machine, with the same bits as on a farm.

#include <atomic>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/render/local_meter.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/film.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// Returns the current clocks of this process.
LocalMeter::Clocks clocks();

struct LocalJob {
  const Scene& scene;
  const RenderSettings& settings;
  Pool& pool;
  const std::atomic<bool>& stop;  ///< setting it to true ends the render with CANCELLED
  LocalMeter& meter;
  /// Called after each band added to a whole image; may be nullptr.
  std::function<void(const Film&)> grown = nullptr;
  /// Returns the error of the image of the first `samples` samples per pixel, which a stop rule of
  /// an error compares with its target. nullptr: the estimate of Film::error is used.
  std::function<absl::StatusOr<double>(const Film&, std::uint64_t samples)> error_of = nullptr;
};

/// Renders the whole image, pass by pass until the stop rule is satisfied. CANCELLED:
/// LocalJob::stop; RESOURCE_EXHAUSTED: out of memory.
absl::StatusOr<Film> render_whole(const LocalJob& job, const StopRule& stop);

/// Renders samples [0, samples) of some rows. The samples are divided into the largest nodes of the
/// summation tree that fit (maximal_nodes in render/band.h), and the first of these into its two
/// halves, because the error estimate needs them. Returns bands for each of these ranges of
/// samples, with as many rows as a band may have.
absl::StatusOr<std::vector<BandPixels>> render_part(const LocalJob& job, const RowRange& rows,
                                                    std::uint64_t samples);

/// Makes the picture of these rows from the bands of render_part().
absl::StatusOr<Image> image_of_part(const std::vector<BandPixels>& bands,
                                    const RenderSettings& settings, const RowRange& rows);

}  // namespace bandsaw::coordinator
