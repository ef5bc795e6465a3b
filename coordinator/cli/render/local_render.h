#pragma once

// Renders an image, or some of its rows, on this machine: the same bits as a farm.

#include <atomic>
#include <functional>
#include <vector>

#include "absl/status/statusor.h"
#include "coordinator/cli/render/local_meter.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/film.h"
#include "renderlib/scene/scene.h"

namespace bandsaw::coordinator {

/// Those of this process, now.
LocalMeter::Clocks clocks();

struct LocalJob {
  const Scene& scene;
  const RenderSettings& settings;
  Pool& pool;
  const std::atomic<bool>& stop;  ///< when it becomes true the render ends with CANCELLED
  LocalMeter& meter;
  /// Hears of each band that was added to a whole image; may be nothing.
  std::function<void(const Film&)> grown = nullptr;
};

/// The whole image, pass by pass until the stop rule holds. CANCELLED; RESOURCE_EXHAUSTED: no
/// memory.
absl::StatusOr<Film> render_whole(const LocalJob& job, const StopRule& stop);

/// Samples [0, samples) of some rows: one band for each maximal node of the samples, of the first
/// one for each half, and as many rows as a band may hold.
absl::StatusOr<std::vector<BandPixels>> render_part(const LocalJob& job, const RowRange& rows,
                                                    std::uint64_t samples);

/// The picture of these rows alone. The bands are those of render_part.
absl::StatusOr<Image> image_of_part(const std::vector<BandPixels>& bands,
                                    const RenderSettings& settings, const RowRange& rows);

}  // namespace bandsaw::coordinator
