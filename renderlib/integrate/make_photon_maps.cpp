// make_photon_maps() traces the photons in chunks, on all threads, and builds the maps from them.
// The other functions exclude scenes in which photons and paths would not find the same light. A
// caster is a surface that casts caustics. A receiver is a surface that scatters light over wide
// angles. Indirect photons start at origins, which are points of receivers.

#include "renderlib/integrate/make_photon_maps.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "renderlib/base/split_mix.h"
#include "renderlib/camera/camera.h"
#include "renderlib/geometry/primitive_list.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/indirect_photons.h"
#include "renderlib/integrate/trace_photons.h"
#include "renderlib/material/interiors.h"
#include "renderlib/material/opacity.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {
namespace {

/// Number of parts in which photons are traced. It is fixed, so that the sums over the parts have
/// the same bits with any number of threads.
constexpr std::uint32_t kChunks = 64;

/// Number of points that are tried for one indirect photon: first kFewOrigins, and kManyOrigins if
/// the effective number of origins is then below kEnoughOrigins. Many are needed where a small part
/// of the surfaces is lit. Elsewhere they take time and do not lower the noise.
constexpr std::uint64_t kFewOrigins = 1;
constexpr std::uint64_t kManyOrigins = 4;
constexpr double kEnoughOrigins = 2048;

/// Each photon spreads its power over a disk. A path takes indirect light from the map if the
/// path's length since the last receiver is at least this many times the mean radius of the disks,
/// weighted by power. So the disks are small as seen from the surface that gathers the light.
constexpr double kGatherRadii = 3;

/// Minimum number of indirect photons, so that disks are small even if the image is small.
constexpr std::uint64_t kMinIndirectPhotons = 1 << 15;

/// Minimum effective number of origins (TracedMaps::effective_origins). With 256, the brightness of
/// all indirect light differs from map to map by about 1 / sqrt(256), which is 6 %.
constexpr double kMinEffectiveOrigins = 256;

/// The radius of an indirect photon's disk is halved up to this many times where the disk reaches
/// an edge or a wall. Otherwise the photon would shine into a dark room behind a thin wall.
constexpr int kMaxHalvings = 3;

/// Maximum number of primitives at which indirect photons start.
constexpr std::uint64_t kMaxPrimitives = std::uint64_t{1} << 21;

/// Returns the point to which the positions of photons are relative: the point that the camera
/// shows in the direction of its view, or else the camera's position. Positions are floats, so they
/// are precise near this point. If the scene lies far from the world's origin, positions relative
/// to that origin would not be precise.
Vec3 origin_of(const Scene& scene) {
  const View view = view_of(scene.camera());
  const Ray ahead{.origin = view.position,
                  .direction = normalize(view.look_at - view.position),
                  .time = middle_of(shutter_of(scene.camera()))};
  const Hit hit = scene.accel().closest(ahead);
  return hit ? ahead.origin + ahead.direction * hit.t : view.position;
}

/// Returns all `count` photons, or points that are tried, of a map.
PhotonChunk all_of(const PhotonMapKey& key, const Vec3& origin, std::uint64_t count) {
  return {.seed = key.seed,
          .map = key.number,
          .photons = count,
          .first = 0,
          .last = count,
          .origin = origin};
}

/// Returns chunk `i` of kChunks.
PhotonChunk chunk_of(const PhotonChunk& all, std::uint64_t i) {
  const std::uint64_t count = all.last - all.first;
  PhotonChunk chunk = all;
  chunk.first = all.first + count * i / kChunks;
  chunk.last = all.first + count * (i + 1) / kChunks;
  return chunk;
}

/// Returns the number of parts into which the shutter interval is divided for map `number`. Light
/// is blurred over a part. The parts become shorter as the disks become smaller: the length of a
/// part falls as the area of the disks does (map_of()).
std::uint32_t parts_of_shutter(const Scene& scene, std::uint32_t number) {
  constexpr double kFirst = 8;
  return scene.moves() ? static_cast<std::uint32_t>(kFirst * pow(number + 1.0, 1.0 / 3)) : 1;
}

/// Builds the map of the photons. Each photon spreads its power over a disk. Knaus and Zwicker
/// multiply the area of the disks of map n = 0, 1, … by about (n + 1)^(alpha - 1), here with alpha
/// = 2/3. So the factor of the area is (n + 1)^(-1/3), and the factor of the radius is the square
/// root of this, (n + 1)^(-1/6). `kind` is 0 for the map of caustics and 1 for the map of indirect
/// light, so that PhotonMap divides space differently for the two maps of one number.
/// `max_halvings` says how often the radius of a disk may be halved where the disk reaches an edge
/// or a wall.
PhotonMap map_of(const Scene& scene, std::vector<StoredPhoton> photons, const Vec3& origin,
                 const PhotonMapKey& key, std::uint64_t kind, int max_halvings,
                 const Preparation& preparation) {
  const double factor = pow(key.number + 1.0, -1.0 / 6);
  return {std::move(photons),
          origin,
          factor,
          split_mix(key.seed ^ key.number ^ kind << 32),
          preparation.pool,
          [&](StoredPhoton& photon) {
            double share = preparation.stopped() ? 1 : share_on_surface(scene, photon, origin);
            for (int i = 0; i < max_halvings && share < 1; ++i) {
              photon.radius /= 2;
              share = share_on_surface(scene, photon, origin);
            }
            return share;
          }};
}

/// Moves the photons of the chunks, in order, into one list, and adds their rays to the maps.
std::vector<StoredPhoton> joined(std::vector<TracedPhotons> chunks, TracedMaps& maps) {
  std::vector<StoredPhoton> photons;
  for (TracedPhotons& chunk : chunks) {
    photons.insert(photons.end(), chunk.photons.begin(), chunk.photons.end());
    chunk.photons = {};
    maps.rays += chunk.rays;
  }
  return photons;
}

/// Adds the map of caustics. Returns false if stopped.
bool add_caustics(const Scene& scene, const PhotonSources& sources, const PhotonMapKey& key,
                  const Vec3& origin, const Preparation& preparation, TracedMaps& maps) {
  maps.parts = parts_of_shutter(scene, key.number);
  PhotonChunk all = all_of(key, origin, key.photons);
  all.parts = maps.parts;
  std::vector<TracedPhotons> chunks(kChunks);
  if (!preparation.run(kChunks, [&](std::uint64_t i) {
        chunks[i] = trace_photons(scene, sources.casters, chunk_of(all, i));
      })) {
    return false;
  }
  double power_by_angle = 0;
  double power = 0;
  for (const TracedPhotons& chunk : chunks) {
    power += chunk.power;
    power_by_angle += chunk.power_by_angle;
  }
  maps.lamp_angle = power > 0 ? power_by_angle / power : 0;
  maps.caustics = map_of(scene, joined(std::move(chunks), maps), origin, key, /*kind=*/0,
                         /*max_halvings=*/0, preparation);
  preparation.advance();
  return !preparation.stopped();
}

/// The origins of indirect photons.
struct Origins {
  std::vector<PhotonOrigin> items;
  std::vector<double> luminance_up_to;  ///< trace_indirect_photons() describes it
  double effective = 0;                 ///< TracedMaps::effective_origins
};

/// Tries the points [all.first, all.last), and adds those that are origins to `origins`, whose
/// items are from the points below all.first. `all.photons` MUST be all.last. Adds the rays to
/// `maps`. Returns false if stopped.
bool add_origins(const Scene& scene, const PhotonSources& sources, const PhotonMaps& caustics,
                 const PhotonChunk& all, const Preparation& preparation, Origins& origins,
                 TracedMaps& maps) {
  std::vector<PhotonOrigins> found(kChunks);
  if (!preparation.run(kChunks, [&](std::uint64_t i) {
        found[i] = find_origins(scene, sources, caustics, chunk_of(all, i));
      })) {
    return false;
  }
  // The powers of the earlier origins were for all.first points.
  const float part = static_cast<float>(all.first) / static_cast<float>(all.last);
  for (PhotonOrigin& origin : origins.items) {
    origin.power = origin.power * part;
  }
  for (PhotonOrigins& chunk : found) {
    maps.rays += chunk.rays;
    origins.items.insert(origins.items.end(), chunk.items.begin(), chunk.items.end());
    chunk.items = {};
  }
  origins.luminance_up_to.clear();
  double sum = 0;
  double squares = 0;
  for (const PhotonOrigin& origin : origins.items) {
    const double power = luminance(origin.power);
    sum += power;
    squares += power * power;
    origins.luminance_up_to.push_back(sum);
  }
  origins.effective = squares > 0 ? sum * sum / squares : 0;
  return true;
}

/// Adds the map of indirect light. `maps` MUST already have the map of caustics, if the sources
/// have casters. Returns false if stopped.
bool add_indirect(const Scene& scene, const PhotonSources& sources, const PhotonMapKey& key,
                  const Vec3& origin, const Preparation& preparation, TracedMaps& maps) {
  PhotonMaps caustics(sources.casters);
  caustics.use_for_all(maps);
  const std::uint64_t photons = std::max(key.photons / 4, kMinIndirectPhotons);
  Origins origins;
  std::uint64_t tried = 0;
  for (const std::uint64_t points : {photons * kFewOrigins, photons * kManyOrigins}) {
    PhotonChunk all = all_of(key, origin, points);
    all.first = tried;
    if (origins.effective < kEnoughOrigins &&
        !add_origins(scene, sources, caustics, all, preparation, origins, maps)) {
      return false;
    }
    tried = points;
  }
  maps.effective_origins = origins.effective;
  std::vector<TracedPhotons> chunks(kChunks);
  if (!origins.items.empty() && !preparation.run(kChunks, [&](std::uint64_t i) {
        chunks[i] = trace_indirect_photons(scene, sources, origins.items, origins.luminance_up_to,
                                           chunk_of(all_of(key, origin, photons), i));
      })) {
    return false;
  }
  maps.indirect = map_of(scene, joined(std::move(chunks), maps), origin, key, /*kind=*/1,
                         kMaxHalvings, preparation);
  double power = 0;
  double radii = 0;
  for (const StoredPhoton& photon : maps.indirect.photons()) {
    power += luminance(photon.power);
    radii += luminance(photon.power) * photon.radius;
  }
  maps.gather_distance = power > 0 ? kGatherRadii * radii / power : 0;
  preparation.advance();
  return !preparation.stopped();
}

/// Returns true if photons may carry light of the scene.
bool has_light_for_photons(const Scene& scene) {
  return scene.lights().any_delta() || scene.background().environment ||
         std::any_of(scene.materials().begin(), scene.materials().end(), [](const Material& m) {
           return std::holds_alternative<Emissive>(m.kind) || !is_black(m.emission.radiance.factor);
         });
}

/// Returns true if photons do not travel through surfaces of this material as paths do:
/// - Hidden lamps: paths pass through them, but a photon ends at any emitter that it hits.
/// - Nested glass: its index of refraction depends on the other glasses around the point, which a
///   photon that starts there does not know.
bool misleads_photons(const Material& material) {
  return is_hidden_lamp(material) || nested_glass(material) != nullptr;
}

}  // namespace

std::uint64_t photons_of_map(std::uint32_t width, std::uint32_t height) {
  return std::clamp(std::uint64_t{4} * width * height, std::uint64_t{1} << 14,
                    std::uint64_t{1} << 18);
}

std::shared_ptr<const TracedMaps> make_photon_maps(const Scene& scene, const PhotonSources& sources,
                                                   const PhotonMapKey& key,
                                                   const Preparation& preparation) {
  const Vec3 origin = origin_of(scene);
  TracedMaps maps;
  if (!sources.casters.empty() && !add_caustics(scene, sources, key, origin, preparation, maps)) {
    return nullptr;
  }
  if (sources.surfaces && !add_indirect(scene, sources, key, origin, preparation, maps)) {
    return nullptr;
  }
  return std::make_shared<const TracedMaps>(std::move(maps));
}

bool can_have_caustic_maps(const Scene& scene, const Casters& casters) {
  // If a part of a mixture is a caster, paths treat this part as a caster, but photons do not start
  // at mixtures.
  const auto hinders = [&](const Material& material) {
    const auto* mix = std::get_if<Mix>(&material.kind);
    return misleads_photons(material) ||
           (mix != nullptr && (casters.casts(mix->a) || casters.casts(mix->b)));
  };
  return !casters.empty() && casters.complete() && has_light_for_photons(scene) &&
         std::none_of(scene.materials().begin(), scene.materials().end(), hinders);
}

bool has_enough_origins(const TracedMaps& maps) {
  return maps.effective_origins >= kMinEffectiveOrigins;
}

bool caustics_pay(const TracedMaps& maps) { return maps.lamp_angle <= kLargestLamp; }

std::optional<SurfaceSampler> surfaces_of_indirect_light(const Scene& scene,
                                                         const Casters& casters) {
  // scene.features() is not used here, because forced features must not change pixels.
  const bool has_media = scene.media().fog || scene.media().has_boundaries();
  const auto hinders = [](const Material& material) {
    return misleads_photons(material) || std::holds_alternative<Mix>(material.kind);
  };
  if (scene.moves() || has_media ||
      std::any_of(scene.materials().begin(), scene.materials().end(), hinders)) {
    return std::nullopt;
  }
  std::vector<bool> scatters;
  for (std::size_t i = 0; i < scene.materials().size(); ++i) {
    const MaterialId id{static_cast<std::uint32_t>(i)};
    scatters.push_back(!std::holds_alternative<Emissive>(scene.material(id).kind) &&
                       !casters.casts(id));
  }
  const PrimitiveList list(scene.geometry(), scatters);
  if (list.size() > kMaxPrimitives) {
    return std::nullopt;
  }
  SurfaceSampler surfaces;
  for (std::uint64_t i = 0; i < list.size(); ++i) {
    if (!surfaces.add(scene, list[i])) {
      return std::nullopt;
    }
  }
  return surfaces.empty() ? std::nullopt : std::optional(std::move(surfaces));
}

}  // namespace bandsaw
