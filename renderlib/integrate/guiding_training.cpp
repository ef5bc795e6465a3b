// Trains the field of path guiding, which holds from where light arrives at the places of a scene.
// The training has three rounds: photons, a small round of paths, and a large round of paths. Each
// round is divided among a fixed number of chunks. The threads trace the chunks. Each chunk gives
// records of the light that arrived at surfaces, and the records of all chunks are joined in order.
// A pilot (the same rounds with fewer photons and paths) decides whether the training pays.
// Gathering means that indirect light comes from photon maps.

#include "renderlib/integrate/guiding_training.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "renderlib/integrate/casters.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/find_portals.h"
#include "renderlib/integrate/guiding_gain.h"
#include "renderlib/integrate/make_photon_maps.h"
#include "renderlib/integrate/training_paths.h"
#include "renderlib/integrate/training_photons.h"

namespace bandsaw {
namespace {

/// Number of chunks of a round. It is fixed, so that the records do not depend on the number of
/// threads.
constexpr std::uint32_t kChunks = 64;

/// The number of pixels on which the training depends is clamped to this range.
constexpr std::uint64_t kMinTrainingPixels = 1 << 15;
constexpr std::uint64_t kMaxTrainingPixels = 1 << 18;
/// The pilot, from which the gain of guiding is estimated, is trained like an image of this many
/// pixels.
constexpr std::uint64_t kPilotPixels = 1 << 13;
/// Number of photons (PhotonMapKey::photons) for the photon maps of indirect light. The pilot and
/// the training both use these maps.
constexpr std::uint64_t kIndirectPhotons = 1 << 16;

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

/// Trains a field for an image of `pixels` pixels. If `casters` is not null, the first round traces
/// photons that start at `casters`. The other two rounds trace paths with `options`; the field of
/// the previous rounds guides these paths. Returns std::nullopt if stopped.
std::optional<TrainedGuiding> train(const Scene& scene, const GuidingKey& key, std::uint64_t pixels,
                                    const Casters* casters, const PathOptions& options,
                                    const Preparation& preparation) {
  TrainedGuiding trained;
  TrainingRecords records;
  if (casters != nullptr && !casters->empty() && scene.features().lights) {
    trained.photons = 2 * pixels / kChunks * kChunks;
    const auto photons = [&](const TrainingChunk& chunk) {
      return training_photons(scene, *casters, key, chunk, trained.photons,
                              options.maps != nullptr && !options.maps->casters().empty());
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

/// Trains a field with few paths and photons, and returns the gain that the field predicts;
/// std::nullopt if stopped. Adds the number of rays to `rays`.
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

/// Photon maps for the training, and the surfaces at which their photons start. If `sources` is
/// null, there are no maps.
struct Mapping {
  std::shared_ptr<const PhotonSources> sources;
  std::shared_ptr<const TracedMaps> maps;
  std::optional<PhotonMaps> of_paths;  ///< holds the maps for all samples
};

/// Makes the maps of these sources with this number of photons; std::nullopt if stopped. Adds the
/// number of rays to `rays`.
std::optional<Mapping> make_mapping(const Scene& scene, PhotonSources sources,
                                    std::uint64_t photons, const Preparation& preparation,
                                    std::uint64_t& rays) {
  constexpr std::uint64_t kSeed = 0x5bd1e9a74c3f2d86;  // arbitrary, for the maps of the training
  Mapping mapping;
  mapping.sources = std::make_shared<const PhotonSources>(std::move(sources));
  mapping.maps =
      make_photon_maps(scene, *mapping.sources, {.seed = kSeed, .photons = photons}, preparation);
  if (mapping.maps == nullptr) {
    return std::nullopt;
  }
  rays += mapping.maps->rays;
  mapping.of_paths.emplace(mapping.sources->casters).use_for_all(*mapping.maps);
  return mapping;
}

/// The decisions about a scene: the light that comes from photon maps, and whether a field is
/// trained. Each function returns false if it was stopped.
class Decisions {
 public:
  Decisions(const Scene& scene, const GuidingKey& key, const Portals& portals,
            const Preparation& preparation)
      : scene_(scene), key_(key), portals_(portals), preparation_(preparation), casters_(scene) {
    options_.max_depth = key.max_depth;
    options_.portals = portals.empty() ? nullptr : &portals;
  }

  /// If `only_if_it_pays` is set, measures the gain of maps and of a field, because this gain then
  /// decides what is used. Otherwise does nothing.
  bool measure() {
    if (key_.only_if_it_pays) {
      gain_ = pilot(scene_, key_, casters_, options_, preparation_, rays_);
    }
    return gain_ || !key_.only_if_it_pays;
  }

  /// Decides whether caustics come from maps: where the maps pay, and where light of delta lights
  /// would be missing without them. If so, measures the gain for the rest of the light.
  bool decide_on_caustics() {
    const bool needed = gain_ ? gain_->misses_light() : scene_.lights().any_delta();
    const bool useful = !gain_ || gain_->maps_pay() || needed;
    if (!useful || !can_have_caustic_maps(scene_, casters_)) {
      return true;
    }
    std::optional<Mapping> mapping =
        make_mapping(scene_, {casters_, std::nullopt, portals_, key_.max_depth},
                     photons_of_map(key_.width, key_.height), preparation_, rays_);
    if (!mapping) {
      return false;
    }
    const TracedMaps& maps = *mapping->maps;
    if (maps.caustics.size() == 0 || !(needed || caustics_pay(maps))) {
      return true;
    }
    use(*std::move(mapping));
    return measure();
  }

  /// Decides whether indirect light comes from maps, with the caustics as decided before.
  bool decide_on_indirect_light() {
    if (gain_ && !gain_->gathering_may_pay()) {
      return true;
    }
    const Casters casters = mapping_.sources != nullptr ? casters_ : Casters::none(scene_);
    std::optional<SurfaceSampler> surfaces = surfaces_of_indirect_light(scene_, casters);
    if (!surfaces) {
      return true;
    }
    std::optional<Mapping> mapping =
        make_mapping(scene_, {casters, std::move(surfaces), portals_, key_.max_depth},
                     kIndirectPhotons, preparation_, rays_);
    if (!mapping) {
      return false;
    }
    if (!has_enough_origins(*mapping->maps)) {
      return true;
    }
    const std::optional<GuidingGain> before = gain_;
    Mapping without = mapping_;
    use(*std::move(mapping));
    if (!measure()) {
      return false;
    }
    if (before && !gathering_pays(*before, *gain_)) {
      gain_ = before;
      use(std::move(without));
    }
    return true;
  }

  /// Trains the field if that pays; std::nullopt if stopped.
  std::optional<TrainedGuiding> trained() const {
    std::optional<TrainedGuiding> trained = TrainedGuiding();
    const bool with_photons = !gain_ || gain_->photons_pay();
    if (with_photons || gain_->paths_pay()) {
      const std::uint64_t pixels = std::clamp(std::uint64_t{key_.width} * key_.height,
                                              kMinTrainingPixels, kMaxTrainingPixels);
      trained =
          train(scene_, key_, pixels, with_photons ? &casters_ : nullptr, options_, preparation_);
    }
    if (trained) {
      trained->rays += rays_;
      trained->portals = portals_;
      trained->sources = mapping_.sources;
    }
    return trained;
  }

 private:
  /// Lets paths use these maps.
  void use(Mapping mapping) {
    mapping_ = std::move(mapping);
    options_.maps = mapping_.of_paths ? &*mapping_.of_paths : nullptr;
  }

  const Scene& scene_;
  const GuidingKey& key_;
  const Portals& portals_;
  const Preparation& preparation_;
  Casters casters_;
  PathOptions options_;
  Mapping mapping_;
  std::optional<GuidingGain> gain_;
  std::uint64_t rays_ = 0;
};

}  // namespace

std::shared_ptr<const TrainedGuiding> train_guiding(const Scene& scene, const GuidingKey& key,
                                                    const Preparation& preparation,
                                                    bool photon_maps) {
  std::uint64_t rays = 0;
  const std::optional<Portals> portals = find_portals(scene, key, preparation, rays);
  if (!portals) {
    return nullptr;
  }
  Decisions decisions(scene, key, *portals, preparation);
  if (!decisions.measure() ||
      (photon_maps && !(decisions.decide_on_caustics() && decisions.decide_on_indirect_light()))) {
    return nullptr;
  }
  std::optional<TrainedGuiding> trained = decisions.trained();
  if (!trained) {
    return nullptr;
  }
  trained->rays += rays;
  return std::make_shared<const TrainedGuiding>(*std::move(trained));
}

}  // namespace bandsaw
