#pragma once

// Training of path guiding by photons: light of lamps that casters (mirrors, glass, metal:
// casters.h) send to other surfaces, which paths from the camera hardly ever find.

#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/training_paths.h"

namespace bandsaw {

/// Traces the photons of a chunk and returns a record for each that arrives at a surface whose
/// direction can be guided. A photon starts at a random point of a caster, from which a light is
/// sampled; it is followed over further mirrors and glass. `photons` is the number of photons in
/// all chunks, among which the power is divided. Media are ignored. With `mapped`, photon maps find
/// the light that arrives at receivers of caustics (caustics.h), so it is not recorded.
TrainingRecords training_photons(const Scene& scene, const Casters& casters, const GuidingKey& key,
                                 const TrainingChunk& chunk, std::uint64_t photons, bool mapped);

}  // namespace bandsaw
