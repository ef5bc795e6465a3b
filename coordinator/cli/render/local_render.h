#pragma once

// Renders an image, or some of its rows, on this machine, for `bandsaw render`. The image has the
// same bits as on a farm. A band is a range of rows and a range of samples.

#include <atomic>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/render/local_meter.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/film.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// Returns the present time and the CPU time of this process.
LocalMeter::Clocks clocks();

/// A scene, its settings, and the threads that render it. The references MUST outlive the render.
struct LocalJob {
  const Scene& scene;
  const RenderSettings& settings;
  Pool& pool;
  const std::atomic<bool>& stop;  ///< setting it to true ends the render with CANCELLED
  LocalMeter& meter;
  /// Called by render_whole() after each band that was added to the film (the sums of all pixels);
  /// may be nullptr.
  std::function<void(const Film&)> grown = nullptr;
  /// Returns the relative RMSE of the image, whose pixels have `samples` samples. A stop rule with
  /// a target for the error compares this value with the target. nullptr: the estimate of
  /// Film::error is used.
  std::function<absl::StatusOr<double>(const Film&, std::uint64_t samples)> error_of = nullptr;
};

/// Renders the whole image, pass by pass, until the stop rule is satisfied. CANCELLED:
/// LocalJob::stop was set. RESOURCE_EXHAUSTED: out of memory. Other errors: those of
/// LocalJob::error_of.
absl::StatusOr<Film> render_whole(const LocalJob& job, const StopRule& stop);

/// Renders samples [0, samples) of some rows. The samples of a pixel are added in a binary tree,
/// whose nodes are ranges of samples. The samples are divided into the largest nodes (maximal_nodes
/// in renderlib/render/band.h). The first node is divided into its two halves, because the error
/// estimate needs them. Returns the bands of all these ranges of samples. Each band has as many
/// rows as kBandPixels pixels allow. Errors: as render_whole().
absl::StatusOr<std::vector<BandPixels>> render_part(const LocalJob& job, const RowRange& rows,
                                                    std::uint64_t samples);

/// Makes the picture of the rows `rows` from the bands that render_part() returned for them.
absl::StatusOr<Image> image_of_part(const std::vector<BandPixels>& bands,
                                    const RenderSettings& settings, const RowRange& rows);

}  // namespace bandsaw::coordinator
