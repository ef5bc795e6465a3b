// The rounds of the training: photons, a small round of paths, a large round of paths. Each is
// divided among a fixed number of chunks, which the threads trace, and whose records are joined in
// order. A pilot (the same rounds with fewer photons and paths) decides whether the training pays.

#include "renderlib/integrate/guiding_training.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/caustic_maps.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/find_portals.h"
#include "renderlib/integrate/guiding_gain.h"
#include "renderlib/integrate/training_paths.h"
#include "renderlib/integrate/training_photons.h"

namespace bandsaw {
namespace {

/// Fixed, so that the records do not depend on the number of threads.
constexpr std::uint32_t kChunks = 64;

/// Smaller and larger images are trained like images of this many pixels.
constexpr std::uint64_t kMinTrainingPixels = 1 << 15;
constexpr std::uint64_t kMaxTrainingPixels = 1 << 18;
/// The pilot, from which the gain of guiding is estimated, is trained like an image of this many.
constexpr std::uint64_t kPilotPixels = 1 << 13;

/// Runs the chunks of a round of `count` paths or photons, appends their records in order, and fits
/// the field to all records. Returns false if stopped.
template <class OfChunk>
bool add_round(std::uint32_t round, std::uint64_t count, const Preparation& preparation,
               TrainingRecords& records, TrainedGuiding& trained, const OfChunk& of_chunk) {
  if (!append_chunks(0, kChunks, preparation, records, [&](std::uint32_t chunk) {
        return of_chunk(TrainingChunk{round, chunk, count / kChunks});
      })) {
    return false;
  }
  trained.rays = records.rays;
  trained.field = GuidingField(records.items, preparation.pool);
  return !preparation.stopped();
}

/// Trains as for an image of this many pixels: with photons that start at `casters` unless that is
/// null, and with paths that have these options, guided by the field so far. Returns std::nullopt
/// if stopped.
std::optional<TrainedGuiding> train(const Scene& scene, const GuidingKey& key, std::uint64_t pixels,
                                    const Casters* casters, const PathOptions& options,
                                    const Preparation& preparation) {
  TrainedGuiding trained;
  TrainingRecords records;
  if (casters != nullptr && !casters->empty() && scene.features().lights) {
    trained.photons = 2 * pixels / kChunks * kChunks;
    const auto photons = [&](const TrainingChunk& chunk) {
      return training_photons(scene, *casters, key, chunk, trained.photons,
                              options.caustics != nullptr);
    };
    if (!add_round(0, trained.photons, preparation, records, trained, photons)) {
      return std::nullopt;
    }
  }
  for (std::uint32_t round = 1; round <= 2; ++round) {
    const std::uint64_t count = pixels / (round == 1 ? 4 : 2) / kChunks * kChunks;
    const GuidingField field = std::move(trained.field);
    PathOptions guided = options;
    guided.guiding = field.cells() == 0 ? nullptr : &field;
    const auto paths = [&](const TrainingChunk& chunk) {
      return training_paths(scene, key, chunk, guided);
    };
    trained.paths += count;
    if (!add_round(round, count, preparation, records, trained, paths)) {
      return std::nullopt;
    }
  }
  return trained;
}

/// Trains a field with few paths and photons, and returns the gain that it predicts; std::nullopt
/// if stopped. Adds to `rays`.
std::optional<GuidingGain> pilot(const Scene& scene, const GuidingKey& key, const Casters& casters,
                                 const PathOptions& options, const Preparation& preparation,
                                 std::uint64_t& rays) {
  const std::optional<TrainedGuiding> trained =
      train(scene, key, kPilotPixels, &casters, options, preparation);
  if (!trained) {
    return std::nullopt;
  }
  rays += trained->rays;
  return expected_gain(scene, key, trained->field, options, preparation);
}

}  // namespace

std::shared_ptr<const TrainedGuiding> train_guiding(const Scene& scene, const GuidingKey& key,
                                                    const Preparation& preparation,
                                                    bool caustic_maps) {
  const auto casters = std::make_shared<const Casters>(scene);
  std::uint64_t rays = 0;
  const std::optional<Portals> portals = find_portals(scene, key, preparation, rays);
  if (!portals) {
    return nullptr;
  }
  PathOptions options{.max_depth = key.max_depth,
                      .portals = portals->empty() ? nullptr : &*portals};
  std::optional<GuidingGain> gain;  // set if the gain decides what is used
  if (key.only_if_it_pays) {
    gain = pilot(scene, key, *casters, options, preparation, rays);
    if (!gain) {
      return nullptr;
    }
  }
  std::shared_ptr<const TracedMap> map;
  std::optional<CausticMaps> caustics;
  if (caustic_maps && (!gain || gain->maps_pay()) && can_have_caustic_maps(scene, *casters)) {
    constexpr std::uint64_t kSeed = 0x5bd1e9a74c3f2d86;  // arbitrary, for the map of the training
    map = make_caustic_map(scene, *casters,
                           {.seed = kSeed, .photons = photons_of_map(key.width, key.height)},
                           preparation);
    if (map == nullptr) {
      return nullptr;
    }
    rays += map->rays;
    if (pays(*map)) {
      caustics.emplace(*casters).use_for_all(map->map);
    }
  }
  options.caustics = caustics ? &*caustics : nullptr;
  if (gain && caustics) {  // the gain of a field for the light that is not in the maps
    gain = pilot(scene, key, *casters, options, preparation, rays);
    if (!gain) {
      return nullptr;
    }
  }
  std::optional<TrainedGuiding> trained = TrainedGuiding();
  const bool with_photons = !gain || gain->photons_pay();
  if (with_photons || gain->paths_pay()) {
    const std::uint64_t pixels =
        std::clamp(std::uint64_t{key.width} * key.height, kMinTrainingPixels, kMaxTrainingPixels);
    trained =
        train(scene, key, pixels, with_photons ? casters.get() : nullptr, options, preparation);
    if (!trained) {
      return nullptr;
    }
  }
  trained->rays += rays;
  trained->portals = *portals;
  trained->casters = caustics ? casters : nullptr;
  return std::make_shared<const TrainedGuiding>(*std::move(trained));
}

}  // namespace bandsaw
