#pragma once

// Visibility and transmittance along shadow rays.

#include <cstdint>

#include "renderlib/geometry/surface.h"
#include "renderlib/light/lights.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Returns the shadow ray from the point to a light that was sampled there.
inline Ray shadow_ray_to(const SurfacePoint& point, const LightSample& light) {
  return light.distant ? spawn_ray(point, light.direction) : spawn_ray_to(point, light.target, 0);
}

/// Returns the share of light, in [0, 1], that the surfaces along the ray let through. Only partly
/// transparent surfaces give other values than 0 and 1. Media are ignored. Adds the number of rays
/// traced to `rays`.
float visibility(const Scene& scene, const Ray& ray, std::uint64_t& rays);

/// Returns visibility() along the ray times the transmittance of the media. The transmittance of a
/// medium that varies in space is an estimate; `numbers` are its random numbers. Adds the number of
/// rays traced to `rays`.
Rgb transmittance(const Scene& scene, const Ray& ray, NumberStream numbers, std::uint64_t& rays);

}  // namespace bandsaw
