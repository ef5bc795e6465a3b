#pragma once

// Training of path guiding by photons. They carry the light of lamps over casters (mirrors, glass,
// metal; casters.h) to other surfaces. Paths from the camera hardly ever find this light.

#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/training_paths.h"

namespace bandsaw {

/// Traces the photons of a chunk. Returns a record for each photon that arrives at a surface where
/// path guiding can choose directions. A photon starts at a random point of a caster, from which a
/// light is sampled. It is followed over further mirrors and glass, at most up to the maximum depth
/// in `key`. The power is divided among the photons of all chunks; `photons` is their number. Media
/// are ignored. If `mapped` is true, photon maps find the light that arrives at receivers of
/// caustics (caustics.h), so arrivals at these receivers are not recorded.
TrainingRecords training_photons(const Scene& scene, const Casters& casters, const GuidingKey& key,
                                 const TrainingChunk& chunk, std::uint64_t photons, bool mapped);

}  // namespace bandsaw
