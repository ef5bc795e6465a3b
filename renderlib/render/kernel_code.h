#pragma once

// The functions of a kernel (kernel.h) other than Scene::build_with and fit(). They are compiled
// once for each kernel, that is, for each instruction set. They MUST only be called through
// `Kernel`, because the machine may lack the instruction set of a kernel.

#include "renderlib/render/hash64.h"
#include "renderlib/render/render_band.h"

namespace bandsaw {

/// Implements Kernel::render_band.
absl::StatusOr<BandPixels> render_band_with_kernel(const Scene& scene,
                                                   const RenderSettings& settings, const Band& band,
                                                   Pool& pool, const std::atomic<bool>& stop,
                                                   const RowsDone& progress,
                                                   const TileSamples& tiles);

/// Implements Kernel::add_elementary_functions.
void add_elementary_functions(Hash64& hash);

}  // namespace bandsaw
