#pragma once

// The value of one sample of a pixel, for every integrator.

#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// Returns the sample's value; the arguments are those of `path_radiance()`. Integrators that do
/// not compute radiance trace only the camera ray, ambient occlusion one more ray.
Rgb sample_value(const Scene& scene, Integrator integrator, const CameraRay& camera_ray,
                 const PixelSampler& sampler, std::uint64_t sample, const PathOptions& options,
                 PathCounts& counts);

}  // namespace bandsaw
