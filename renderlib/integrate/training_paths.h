#pragma once

// Training of path guiding by paths from the camera: they record from which directions they found
// light. guiding_training.cpp fits the guiding field to these records. The field tells for each
// place from which directions light arrives.

#include <cstdint>
#include <vector>

#include "renderlib/camera/camera.h"
#include "renderlib/guiding/guiding_cache.h"
#include "renderlib/guiding/guiding_record.h"
#include "renderlib/integrate/path.h"
#include "renderlib/integrate/preparation.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Some of the training paths or photons of one round. A chunk is traced by one thread.
struct TrainingChunk {
  /// 0: photons; 1 and 2: paths (guiding_training.h); 3: paths that find portals (find_portals.h).
  std::uint32_t round = 0;
  std::uint32_t number = 0;  ///< of the chunk within its round
  std::uint64_t count = 0;   ///< number of paths or photons
};

/// The results of a chunk, in the order of its paths or photons.
template <class Item>
struct Traced {
  std::vector<Item> items;
  std::uint64_t rays = 0;  ///< rays that were traced
};
using TrainingRecords = Traced<GuidingRecord>;

/// Calls `of_chunk` with the number of each chunk in [first, last), on the threads of
/// `preparation`. Appends the results to `to`, in the order of the numbers. If the preparation is
/// stopped, returns false and appends nothing.
template <class Item, class OfChunk>
bool append_chunks(std::uint32_t first, std::uint32_t last, const Preparation& preparation,
                   Traced<Item>& to, const OfChunk& of_chunk) {
  std::vector<Traced<Item>> chunks(last - first);
  if (!preparation.run(last - first,
                       [&](std::uint32_t number) { chunks[number] = of_chunk(first + number); })) {
    return false;
  }
  for (const Traced<Item>& chunk : chunks) {
    to.items.insert(to.items.end(), chunk.items.begin(), chunk.items.end());
    to.rays += chunk.rays;
  }
  return true;
}

/// Traces the paths of a chunk through random places of the image. Of each path, returns records
/// for the first eight vertices at which the direction can be guided. A record holds the light that
/// the path found after the vertex; light sampling at the vertex itself is excluded.
TrainingRecords training_paths(const Scene& scene, const GuidingKey& key,
                               const TrainingChunk& chunk, const PathOptions& options);

/// Returns the camera ray of path number `sample`. The ray passes through a random place of the
/// image, whose size is in `key`, at a random time of the exposure.
Ray training_ray(const Scene& scene, const RayGenerator& camera, const GuidingKey& key,
                 const PixelSampler& sampler, std::uint64_t sample);

/// Returns the sampler of a chunk. It is the sampler of a pixel outside of the largest image, so no
/// image uses the same random numbers.
PixelSampler training_sampler(const TrainingChunk& chunk);

}  // namespace bandsaw
