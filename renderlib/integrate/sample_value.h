#pragma once

// Computes one sample of a pixel with the integrator that the settings select.
// render/pixel_sums.cpp calls it for every sample.

#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// Returns the sample's value; the arguments are those of `path_radiance()`. Integrators that do
/// not compute radiance ignore `options`. Ambient occlusion traces the camera ray and one more ray.
/// The remaining integrators trace only the camera ray. `integrator` MUST NOT be a guide, which is
/// an auxiliary image for the denoiser (guide.h).
Rgb sample_value(const Scene& scene, Integrator integrator, const CameraRay& camera_ray,
                 const PixelSampler& sampler, std::uint64_t sample, const PathOptions& options,
                 PathCounts& counts);

}  // namespace bandsaw
