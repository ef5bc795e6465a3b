#pragma once

// Photons of caustics. They carry light of emissive surfaces, of delta lights and of the bright
// places of an environment (photons_carry()) to a surface that receives caustics (caustics.h). On
// the way, one or more casters (surfaces of metal or glass, casters.h) scatter the light, and
// nothing else does.

#include <cstdint>
#include <vector>

#include "renderlib/guiding/photon_map.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/photon_start.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Some of the photons of a map: those with numbers in [first, last).
struct PhotonChunk {
  std::uint64_t seed = 0;
  std::uint32_t map = 0;      ///< number of the map (PhotonMaps::number_of)
  std::uint64_t photons = 0;  ///< number of photons that are started for the whole map
  std::uint64_t first = 0;
  std::uint64_t last = 0;
  Vec3 origin = {};         ///< the point to which the positions of stored photons are relative
  std::uint32_t parts = 1;  ///< parts of the shutter interval (TracedMaps::parts)
};

/// The photons of a chunk.
struct TracedPhotons {
  std::vector<StoredPhoton> photons;  ///< those that arrived at a receiver, in order
  std::uint64_t rays = 0;             ///< rays that were traced
  double power = 0;  ///< sum over `photons` of the luminance of StoredPhoton::power
  /// Sum over `photons` of the luminance of StoredPhoton::power times the solid angle of the lamp,
  /// as seen from the point at which the photon started. The solid angle is estimated as 1 / pdf,
  /// where pdf is the pdf of light sampling at that point.
  double power_by_angle = 0;
};

/// Traces the photons. A photon starts at a random point of a caster, with the light of a lamp that
/// is sampled from this point. The path of a photon is a pure function of the scene, the seed, the
/// number of the map and the number of the photon. The power of the photon is divided by
/// PhotonChunk::photons. `casters` MUST be complete (Casters::complete).
TracedPhotons trace_photons(const Scene& scene, const Casters& casters, const PhotonChunk& chunk);

/// Returns the photon as a map holds it. It arrived with the power `power` at the receiver `hit`,
/// from direction `from`, after `chain` scatterings. A partly transparent receiver, or one in a
/// mixture, is present with some probability, and paths look up photons only where it is present.
/// So the map holds `power` divided by this probability. The photon's position is relative to
/// `origin`.
StoredPhoton stored_photon(const Scene& scene, const Casters& casters, const SurfacePoint& hit,
                           const Vec3& from, std::uint32_t chain, Rgb power, const Vec3& origin);

/// Returns the share, in [1/4, 1], of the photon's disk that lies on surfaces. It is estimated by
/// short rays, first at the rim and, if some miss, all over the disk. PhotonMap divides the power
/// by this share; otherwise a photon near an edge would lose the power that falls beyond the edge.
/// The photon's position is relative to `origin`.
double share_on_surface(const Scene& scene, const StoredPhoton& photon, const Vec3& origin);

}  // namespace bandsaw
