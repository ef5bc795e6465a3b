#pragma once

// What a kernel is made of beside Scene::build_with. These functions are compiled once for each
// kernel; they are called through Kernel alone, which knows whether the machine runs them.

#include "renderlib/render/hash64.h"
#include "renderlib/render/render_band.h"

namespace bandsaw {

/// Kernel::render_band.
absl::StatusOr<BandPixels> render_band_with_kernel(const Scene& scene,
                                                   const RenderSettings& settings, const Band& band,
                                                   Pool& pool, const std::atomic<bool>& stop,
                                                   const RowsDone& progress,
                                                   const TileSamples& tiles);

/// Kernel::add_elementary_functions.
void add_elementary_functions(Hash64& hash);

}  // namespace bandsaw
