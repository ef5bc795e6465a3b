// The rounds of the training: photons, a small round of paths, a large round of paths. Each is
// divided among a fixed number of chunks, which the threads trace, and whose records are joined in
// order.

#include "renderlib/integrate/guiding_training.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/caustic_maps.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/training_paths.h"
#include "renderlib/integrate/training_photons.h"

namespace bandsaw {
namespace {

constexpr std::uint32_t kChunks = 64;

/// Smaller and larger images are trained like images of this many pixels.
constexpr std::uint64_t kMinTrainingPixels = 1 << 15;
constexpr std::uint64_t kMaxTrainingPixels = 1 << 18;

/// Runs the chunks of a round and appends their records in order. Returns false if stopped.
template <class OfChunk>
bool add_round(std::uint32_t round, std::uint64_t count, Pool& pool, const std::atomic<bool>& stop,
               std::vector<GuidingRecord>& records, TrainedGuiding& trained,
               const OfChunk& of_chunk) {
  std::vector<TrainingRecords> chunks(kChunks);
  pool.parallel_for(kChunks, [&](std::int64_t number) {
    if (!stop.load(std::memory_order_relaxed)) {
      const auto chunk = static_cast<std::uint32_t>(number);
      chunks[chunk] = of_chunk(TrainingChunk{round, chunk, count / kChunks});
    }
  });
  for (const TrainingRecords& chunk : chunks) {
    records.insert(records.end(), chunk.records.begin(), chunk.records.end());
    trained.rays += chunk.rays;
  }
  trained.field = GuidingField(records, pool);
  return !stop.load(std::memory_order_relaxed);
}

}  // namespace

std::shared_ptr<const TrainedGuiding> train_guiding(const Scene& scene, const GuidingKey& key,
                                                    Pool& pool, const std::atomic<bool>& stop,
                                                    bool caustic_maps) {
  const std::uint64_t pixels =
      std::clamp(std::uint64_t{key.width} * key.height, kMinTrainingPixels, kMaxTrainingPixels);
  TrainedGuiding trained;
  std::vector<GuidingRecord> records;
  const auto casters = std::make_shared<const Casters>(scene);
  std::shared_ptr<const TracedMap> map;
  std::optional<CausticMaps> caustics;
  if (caustic_maps && can_have_caustic_maps(scene, *casters)) {
    constexpr std::uint64_t kSeed = 0x5bd1e9a74c3f2d86;
    map = make_caustic_map(scene, *casters,
                           {.seed = kSeed, .photons = photons_of_map(key.width, key.height)}, pool,
                           stop);
    if (map == nullptr) {
      return nullptr;
    }
    trained.rays += map->rays;
    if (pays(*map)) {
      trained.casters = casters;
      caustics.emplace(*casters).use_for_all(map->map);
    }
  }
  if (!casters->empty() && scene.features().lights) {
    trained.photons = 2 * pixels / kChunks * kChunks;
    const auto photons = [&](const TrainingChunk& chunk) {
      return training_photons(scene, *casters, key, chunk, trained.photons, caustics.has_value());
    };
    if (!add_round(0, trained.photons, pool, stop, records, trained, photons)) {
      return nullptr;
    }
  }
  for (std::uint32_t round = 1; round <= 2; ++round) {
    const std::uint64_t count = pixels / (round == 1 ? 4 : 2) / kChunks * kChunks;
    const GuidingField field = std::move(trained.field);
    const auto paths = [&](const TrainingChunk& chunk) {
      return training_paths(scene, key, chunk, field.cells() == 0 ? nullptr : &field,
                            caustics ? &*caustics : nullptr);
    };
    trained.paths += count;
    if (!add_round(round, count, pool, stop, records, trained, paths)) {
      return nullptr;
    }
  }
  return std::make_shared<const TrainedGuiding>(std::move(trained));
}

}  // namespace bandsaw
