#pragma once

// The surfaces at which the photons of a scene's photon maps start. Unlike in usual photon
// mapping, photons do not start at lights: a point of these surfaces is sampled, and the light that
// arrives there is found by light sampling.

#include <optional>

#include "renderlib/guiding/portals.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/surface_sampler.h"

namespace bandsaw {

/// The surfaces at which photons start. They determine which light comes from photon maps. The
/// training of path guiding (integrate/guiding_training.h) chooses them.
struct PhotonSources {
  /// Surfaces that cast caustics. If there are any, caustics come from maps (caustics.h), otherwise
  /// caustics are left to paths.
  Casters casters;
  /// Set if indirect light comes from maps (indirect_photons.h): all surfaces that can scatter it,
  /// except casters.
  std::optional<SurfaceSampler> surfaces = std::nullopt;
  /// Openings to the background, such as windows. Where a photon of indirect light starts, the
  /// background that lights this point is sampled through them.
  Portals portals = {};
  std::uint32_t max_depth = 0;  ///< maximum number of scatterings of a path
};

}  // namespace bandsaw
