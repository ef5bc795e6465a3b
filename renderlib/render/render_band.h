#pragma once

// The facade: one band of an image, on all threads of a pool.

#include <atomic>
#include <functional>

#include "absl/status/statusor.h"
#include "renderlib/base/pool.h"
#include "renderlib/render/band.h"
#include "renderlib/render/settings.h"
#include "renderlib/render/tile_samples.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Called from a pool thread each time a whole row has been finished, with the number of rows
/// finished so far (each value 1..rows once, possibly out of order); MUST be quick and thread-safe.
using RowsDone = std::function<void(std::uint32_t)>;

/// Renders the band. The pixels depend on scene, settings and band alone. Checks `stop` at least
/// once a row of a tile: CANCELLED when it was set. INVALID_ARGUMENT: settings or band out of
/// range. `tiles`: what half tiles take, of rows that include the band's; sums of nothing are zero.
absl::StatusOr<BandPixels> render_band(const Scene& scene, const RenderSettings& settings,
                                       const Band& band, Pool& pool, const std::atomic<bool>& stop,
                                       const RowsDone& progress, const TileSamples& tiles = {});

}  // namespace bandsaw
