#pragma once

// Makes the photon maps of a scene, and says for which scenes they can be made.

#include <cstdint>
#include <memory>
#include <optional>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/integrate/photon_sources.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Returns the number of photons of caustics that are started for each map of an image of this size
/// in pixels. It is 4 for each pixel, clamped to [2^14, 2^18]. Within these limits, each of the
/// first maps is shared by twice as many paths as it has photons. The number of indirect photons is
/// a quarter of the number for caustics, but at least 2^15. Fewer are enough, because paths see
/// these photons from afar and average their noise.
std::uint64_t photons_of_map(std::uint32_t width, std::uint32_t height);

/// Makes the map of caustics if the sources have casters (surfaces that cast caustics), and the map
/// of indirect light if the sources have surfaces. The result is a pure function of the scene, the
/// sources and the key. The radii fall with the number of the map, so that the mean over maps
/// converges to the irradiance (Knaus and Zwicker 2011, "Progressive Photon Mapping: A
/// Probabilistic Approach", section 4, alpha = 2/3). Returns nullptr if the preparation was
/// stopped.
std::shared_ptr<const TracedMaps> make_photon_maps(const Scene& scene, const PhotonSources& sources,
                                                   const PhotonMapKey& key,
                                                   const Preparation& preparation);

/// Returns true if caustics can come from maps. The scene must have casters, all of which can be
/// sampled, and an emissive surface, a delta light or an environment. It must have no glass with
/// priorities, no mixtures with casters and no hidden lamps,
/// because with any of these, photons would not travel exactly as paths do.
bool can_have_caustic_maps(const Scene& scene, const Casters& casters);

/// Returns true if photon maps of caustics are better than paths: the lamps are small as seen from
/// the casters, so that paths hardly find them. The map of caustics MUST NOT be empty.
bool caustics_pay(const TracedMaps& maps);

/// Returns true if the photons of indirect light start at enough different points. In a scene of
/// which only a small room is lit, they may start at few points. Then the brightness of all
/// indirect light would depend on the few points that each map happens to choose. The pilot (a
/// short trial, see guiding_training.cpp) cannot measure this error, because it sees only one map.
bool has_enough_origins(const TracedMaps& maps);

/// Returns the surfaces at which indirect photons start (PhotonSources::surfaces). Returns
/// std::nullopt if indirect light cannot come from maps. This is so if the scene has no such
/// surface, or if such surfaces have more than 2^21 primitives or an area that is not finite. It is
/// also so if the scene has motion except that of the camera, media, mixtures, glass with
/// priorities or hidden lamps, because with any of these, photons would not travel exactly as paths
/// do.
std::optional<SurfaceSampler> surfaces_of_indirect_light(const Scene& scene,
                                                         const Casters& casters);

}  // namespace bandsaw
