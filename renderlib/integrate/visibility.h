#pragma once

// Visibility and transmittance along shadow rays.

#include <cstdint>

#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Returns the visibility between surfaces along the ray, in [0, 1]: 0 or 1 except for
/// alpha-blended surfaces. Media are ignored. Adds the number of rays traced to `rays`.
float visibility(const Scene& scene, const Ray& ray, std::uint64_t& rays);

/// Returns the transmittance along the ray: visibility between surfaces times the transmittance of
/// media, which is an estimate from `numbers` where they vary in space. Adds the number of rays
/// traced to `rays`.
Rgb transmittance(const Scene& scene, const Ray& ray, NumberStream numbers, std::uint64_t& rays);

}  // namespace bandsaw
