#pragma once

// Training of path guiding by paths from the camera: they record from which directions they found
// light. guiding_training.cpp fits the field to these records.

#include <cstdint>
#include <vector>

#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/guiding_record.h"
#include "renderlib/integrate/path.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Some of the training paths or photons of one round. A chunk is traced by one thread.
struct TrainingChunk {
  std::uint32_t round = 0;   ///< 0: photons; 1 and 2: paths (guiding_training.h)
  std::uint32_t number = 0;  ///< of the chunk within its round
  std::uint64_t count = 0;   ///< number of paths or photons
};

/// Records of a chunk, in the order of its paths or photons.
struct TrainingRecords {
  std::vector<GuidingRecord> records;
  std::uint64_t rays = 0;  ///< rays that were traced
};

/// Traces the paths of a chunk through random places of the image. Returns a record for each of the
/// first eight vertices of a path whose direction can be guided. It holds the light that the path
/// found after that vertex; light sampling at the vertex itself is excluded.
TrainingRecords training_paths(const Scene& scene, const GuidingKey& key,
                               const TrainingChunk& chunk, const PathOptions& options);

/// Returns the sampler of a chunk. It is that of a pixel outside of the largest image, so no image
/// uses the same random numbers.
PixelSampler training_sampler(const TrainingChunk& chunk);

}  // namespace bandsaw
