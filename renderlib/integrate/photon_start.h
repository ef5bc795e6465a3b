#pragma once

// Where the photons of caustics start: those of a photon map (trace_photons.h) and those that train
// path guiding (training_photons.h).

#include <cstdint>
#include <optional>

#include "renderlib/integrate/casters.h"
#include "renderlib/light/lights.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Longer chains of casters are left to path tracing.
inline constexpr std::uint32_t kMaxCausticChain = 16;

/// A random point of a caster, and a light that is sampled from there.
struct PhotonStart {
  SurfacePoint point;
  Vec3 normal;  ///< geometric normal of one side, each with probability 1/2
  LightSample light;
  double pdf = 0;  ///< pdf of the point by area, > 0
};

/// `sampler` and `sample` give the random numbers. Returns std::nullopt if no light can be sampled
/// from the point.
std::optional<PhotonStart> start_photon(const Scene& scene, const Casters& casters,
                                        const PixelSampler& sampler, std::uint64_t sample,
                                        double time);

}  // namespace bandsaw
