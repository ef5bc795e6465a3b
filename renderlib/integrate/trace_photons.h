#pragma once

// Photons of caustics: light of emissive surfaces that one or more casters (casters.h), and nothing
// else, send to a surface that receives caustics (caustics.h).

#include <cstdint>
#include <vector>

#include "renderlib/guiding/photon_map.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/photon_start.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Some of the photons of a map.
struct PhotonChunk {
  std::uint64_t seed = 0;
  std::uint32_t map = 0;      ///< number of the map
  std::uint64_t photons = 0;  ///< number of photons of the map
  std::uint64_t first = 0;    ///< photons [first, last)
  std::uint64_t last = 0;
};

struct TracedPhotons {
  std::vector<CausticPhoton> photons;  ///< those that arrived, in order
  std::uint64_t rays = 0;
  double power = 0;  ///< sum of the luminance of their power
  /// Sum of luminance times the solid angle of the light as seen from the first caster, by the pdf
  /// with which light sampling chose it.
  double power_by_angle = 0;
};

/// Traces the photons, each of which is a pure function of the scene, the seed, the map and its
/// number. A photon starts at a random point of a caster, from which a light is sampled as for a
/// surface. `casters` MUST be complete.
TracedPhotons trace_photons(const Scene& scene, const Casters& casters, const PhotonChunk& chunk);

/// Returns the share of the photon's disk that lies on surfaces around it: estimated by short rays,
/// first at the rim and, if some miss, all over the disk. Without that, a photon near an edge would
/// lose the part of its power that falls beyond it.
double share_on_surface(const Scene& scene, const CausticPhoton& photon);

}  // namespace bandsaw
