#pragma once

// What one sample of a pixel adds to it, by any integrator.

#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// As path_radiance, whose arguments these are; of an integrator that follows no light only the
/// camera ray, and for occlusion one more, is traced.
Rgb sample_value(const Scene& scene, Integrator integrator, const CameraRay& camera_ray,
                 const PixelSampler& sampler, std::uint64_t sample, const PathOptions& options,
                 PathCounts& counts);

}  // namespace bandsaw
