#pragma once

// Makes the photon maps of a scene, and decides whether they pay: whether the error falls by more
// than they cost in time.

#include <cstdint>
#include <memory>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Returns the number of photons that are started for each map of an image of this size in pixels:
/// 8 for each pixel, half as many as the paths that share a map, but between 2^15 and 2^19.
std::uint64_t photons_of_map(std::uint32_t width, std::uint32_t height);

/// Traces and builds a map: a pure function of the scene and the key. The radii fall with the
/// number of the map, so that the mean over maps converges to the irradiance (Knaus and Zwicker
/// 2011, "Progressive Photon Mapping: A Probabilistic Approach", section 4, alpha = 2/3). Returns
/// nullptr if it was stopped.
std::shared_ptr<const TracedMap> make_caustic_map(const Scene& scene, const Casters& casters,
                                                  const PhotonMapKey& key,
                                                  const Preparation& preparation);

/// Returns true if photon maps can be made: the scene has casters, all of which can be sampled, and
/// emissive surfaces; and it has no motion, no glass with priorities, no mixtures with casters and
/// no hidden lamps, with which photons would not travel exactly as paths do.
bool can_have_caustic_maps(const Scene& scene, const Casters& casters);

/// Returns true if photon maps are better than paths: photons arrive, and the lamps are small as
/// seen from the casters, so that paths hardly find them.
bool pays(const TracedMap& map);

}  // namespace bandsaw
