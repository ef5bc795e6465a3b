#pragma once

// Facade of the renderer: renders one band (some rows, some samples: band.h) of an image on all
// threads of a pool.

#include <atomic>
#include <functional>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Called from a pool thread each time a row is complete, with the number of complete rows. Each
/// number from 1 to the number of rows is passed once, possibly out of order. Also called with 0
/// after each step of a preparation, such as the training of path guiding
/// (integrate/preparation.h). MUST be fast and thread-safe.
using RowsDone = std::function<void(std::uint32_t)>;

/// Renders the band. The pixels depend only on scene, settings, band and `tiles`. `tiles` is for
/// adaptive sampling: it states the samples of each half tile (half of a tile of 16 x 16 pixels,
/// tile_samples.h), and MUST include the rows of the band. By default, all half tiles take the
/// samples of the band. Sums of pixels without samples are zero. `progress` may be empty. Checks
/// `stop` at least once per row of a tile, and returns CANCELLED if `stop` is set. Returns
/// INVALID_ARGUMENT if settings or band are out of range.
absl::StatusOr<BandPixels> render_band(const Scene& scene, const RenderSettings& settings,
                                       const Band& band, Pool& pool, const std::atomic<bool>& stop,
                                       const RowsDone& progress, const TileSamples& tiles = {});

}  // namespace bandsaw
