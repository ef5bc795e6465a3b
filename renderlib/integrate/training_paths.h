#pragma once

// Training of path guiding by paths from the camera.

#include <cstdint>
#include <vector>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/guiding_record.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

class CausticMaps;  // renderlib/integrate/caustics.h

/// Some of the training paths, or photons, of one round.
struct TrainingChunk {
  std::uint32_t round = 0;
  std::uint32_t number = 0;
  std::uint64_t count = 0;  ///< number of paths or photons
};

/// Records of a chunk, in order.
struct TrainingRecords {
  std::vector<GuidingRecord> records;
  std::uint64_t rays = 0;
};

/// Traces the paths of a chunk through random places of the image, guided by `field` and with the
/// caustics of `caustics` if they are not null, and returns a record for each vertex whose
/// direction can be guided: the light that the path found from there on, light sampling at the
/// vertex excluded.
TrainingRecords training_paths(const Scene& scene, const GuidingKey& key,
                               const TrainingChunk& chunk, const GuidingField* field,
                               const CausticMaps* caustics);

/// The numbers of training are those of pixels beyond the largest image.
PixelSampler training_sampler(const TrainingChunk& chunk);

}  // namespace bandsaw
