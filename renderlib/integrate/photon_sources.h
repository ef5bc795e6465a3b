#pragma once

// The surfaces at which the photons of a scene's photon maps start.

#include <optional>

#include "renderlib/guiding/portals.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/surface_sampler.h"

namespace bandsaw {

/// Where photons start, and by that which light comes from photon maps.
/// integrate/guiding_training.h decides on it.
struct PhotonSources {
  /// Surfaces that cast caustics, which then come from maps (caustics.h); without casters, caustics
  /// are left to paths.
  Casters casters;
  /// Set if indirect light comes from maps (indirect_photons.h): all surfaces that can scatter it,
  /// except casters.
  std::optional<SurfaceSampler> surfaces = std::nullopt;
  /// Openings through which the background is sampled where indirect photons start.
  Portals portals = {};
  std::uint32_t max_depth = 0;  ///< maximum number of scatterings of a path
};

}  // namespace bandsaw
