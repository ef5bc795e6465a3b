#pragma once

// Chooses where the photons of caustics start: those of a photon map (trace_photons.h) and those
// that train path guiding (training_photons.h). They start at casters, which are surfaces that cast
// caustics (casters.h), and not at lights. So no photon misses the casters.

#include <cstdint>
#include <optional>

#include "renderlib/integrate/casters.h"
#include "renderlib/light/lights.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Maximum number of casters that a photon meets one after the other. Light over more of them is
/// left to path tracing.
inline constexpr std::uint32_t kMaxCausticChain = 16;

/// Largest solid angle of a lamp as seen from a caster, in steradians, for which photon maps pay.
/// Paths hit larger lamps often enough, so that their caustics have little noise anyway.
inline constexpr double kLargestLamp = 0.5;

/// Returns true if photons carry the light of the environment from this direction. This is so if
/// the environment is so bright there that light sampling has a pdf as for a lamp of kLargestLamp.
/// The sun in an image of the sky is such a place.
inline bool photons_carry(const Lights& lights, const Vec3& direction) {
  return lights.direction_pdf_of_environment(direction) >= 1 / kLargestLamp;
}

/// Returns true if the photons of photon maps carry the light of this sample. They carry the light
/// of emissive surfaces and delta lights, and of the bright places of an environment.
inline bool photons_carry(const Lights& lights, const LightSample& light) {
  return light.delta || !light.distant || photons_carry(lights, light.direction);
}

/// A random point of a caster, and a light that is sampled from there.
struct PhotonStart {
  SurfacePoint point;
  Vec3 normal;  ///< geometric normal of one side; each side has probability 1/2
  LightSample light;
  double pdf = 0;  ///< pdf of the point by area, > 0
};

/// Chooses a time while the shutter is open and a point of a caster at random, and samples a light
/// as seen from this point at this time. `sampler` and `sample` give the random numbers. Returns
/// std::nullopt if the point's primitive has no area or no light can be sampled from the point.
std::optional<PhotonStart> start_photon(const Scene& scene, const Casters& casters,
                                        const PixelSampler& sampler, std::uint64_t sample);

}  // namespace bandsaw
