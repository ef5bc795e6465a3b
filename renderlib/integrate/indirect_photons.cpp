// find_origins() samples points of receivers (surfaces that scatter light over wide angles) and a
// direction for each point. A path measures how much light leaves the point in this direction.
// trace_indirect_photons() starts photons at these points, and stores them at the receivers that
// they meet.

#include "renderlib/integrate/indirect_photons.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/scatter_photon.h"
#include "renderlib/material/opacity.h"
#include "renderlib/math/constants.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// These functions return the random numbers of origins and of photons, which are the random
/// numbers of pixels outside of all images. Origins and photons have one column of pixels each.
/// Photons of caustics use column kBeyondImages.
PixelSampler sampler_of_origins(const PhotonChunk& chunk) {
  return {chunk.seed, kBeyondImages + 1, kBeyondImages + chunk.map};
}
PixelSampler sampler_of_photons(const PhotonChunk& chunk) {
  return {chunk.seed, kBeyondImages + 2, kBeyondImages + chunk.map};
}

/// A random point of a receiver, and a direction.
struct Place {
  SurfacePoint point;
  Vec3 normal;     ///< geometric normal of one side; each side has probability 1/2
  Vec3 direction;  ///< unit, on that side; sampled with the pdf cosine / pi
  double pdf = 0;  ///< pdf of the point by area, > 0
};

/// Samples a direction on the side of the normal with the pdf cosine / pi. Returns std::nullopt if
/// the sample is not on that side.
std::optional<Vec3> direction_from(const Vec3& normal, double u, double v) {
  const Vec3 direction =
      normalize(orthonormal_basis(normal).to_world(sample_cosine_hemisphere(u, v)));
  return dot(direction, normal) > 0 ? std::optional(direction) : std::nullopt;
}

/// Returns the place with this number. Returns std::nullopt if no point or no direction can be
/// sampled.
std::optional<Place> place_of(const Scene& scene, const PhotonSources& sources,
                              const PixelSampler& sampler, std::uint64_t number) {
  const Sample4 where = sampler.group(number, kGroupCamera);
  const Sample4 more = sampler.group(number, kGroupTime);
  const double time = middle_of(shutter_of(scene.camera()));
  // The number more[3] refines the selection among many primitives.
  std::optional<SurfaceSample> at =
      sources.surfaces->sample(scene, where[0] + more[3] * 0x1p-32, where[1], where[2], time);
  if (!at) {
    return std::nullopt;
  }
  at->point.time = time;
  add_directions(scene, at->point);
  const Vec3 normal = where[3] < 0.5 ? at->point.geometric_normal : -at->point.geometric_normal;
  const std::optional<Vec3> direction = direction_from(normal, more[0], more[1]);
  return direction ? std::optional(Place{at->point, normal, *direction, at->pdf}) : std::nullopt;
}

/// After kLongChain scatterings, Russian roulette may end a photon even if nothing is absorbed. The
/// photon survives each further scattering with a probability of at most kSurvival. So for each
/// photon that starts, at most kLongChain + 1 / (1 - kSurvival) are stored on average.
constexpr std::uint32_t kLongChain = 8;
constexpr double kSurvival = 0.75;

/// Follows a photon that has left an origin, and adds it to `out` at each receiver that it meets.
/// At the first receiver, it is added with `share` times its power, and not added if `share` is 0.
void follow(const Scene& scene, const PhotonSources& sources, const PixelSampler& sampler,
            std::uint64_t number, Ray ray, Rgb power, float share, const Vec3& origin,
            TracedPhotons& out) {
  NestedDielectrics nesting;
  std::uint32_t uncounted = 0;  // scatterings that do not count towards max_depth
  for (std::uint32_t chain = 1; chain - uncounted < sources.max_depth && uncounted < kMaxUncounted;
       ++chain) {
    const std::optional<SurfacePoint> hit =
        intersect_visible(scene, ray, sampler, number, chain, nesting, out.rays);
    if (!hit || std::holds_alternative<Emissive>(scene.material(hit->material).kind)) {
      return;
    }
    const Vec3 from = -ray.direction;
    const Bsdf bsdf = bsdf_at(scene.material(hit->material), scene.textures(), *hit, from);
    if (caustic_role(sources.casters, *hit, hit->material, bsdf) == CausticRole::kReceiver) {
      if (share > 0) {
        out.photons.push_back(stored_photon(scene, sources.casters, *hit, from, chain - uncounted,
                                            power * share, origin));
      }
      share = 1;
    }
    const std::optional<PhotonScattering> next =
        scatter_photon(scene, *hit, from, sampler.group(number, group_bsdf(chain)));
    if (!next) {
      return;
    }
    // Russian roulette: the share of photons that is absorbed ends, and the others keep their
    // power.
    const Rgb scattered = power * next->factor;
    const double survival = std::min(chain < kLongChain ? 1 : kSurvival,
                                     double{max_component(scattered)} / max_component(power));
    if (!(sampler.group(number, group_light(chain))[0] < survival) || !is_finite(scattered)) {
      return;
    }
    uncounted += next->counts ? 0 : 1;
    power = scattered * static_cast<float>(1 / survival);
    ray = spawn_ray(*hit, next->out);
  }
}

}  // namespace

PhotonOrigins find_origins(const Scene& scene, const PhotonSources& sources, const PhotonMaps& maps,
                           const PhotonChunk& chunk) {
  const PixelSampler sampler = sampler_of_origins(chunk);
  const PathOptions options{.max_depth = sources.max_depth,
                            .maps = &maps,
                            .portals = sources.portals.empty() ? nullptr : &sources.portals};
  PhotonOrigins out;
  for (std::uint64_t number = chunk.first; number < chunk.last; ++number) {
    const std::optional<Place> place = place_of(scene, sources, sampler, number);
    if (!place) {
      continue;
    }
    const SurfacePoint& point = place->point;
    const PathContext context{scene, sampler, number, options, out.rays};
    PathState path({.origin = point.position + place->direction,
                    .direction = -place->direction,
                    .time = point.time});
    const std::optional<Bsdf> bsdf = make_bsdf(context, point, 0, path);
    if (!bsdf ||
        caustic_role(sources.casters, point, point.material, *bsdf) != CausticRole::kReceiver) {
      continue;
    }
    if (scatter(context, point, *bsdf, {}, 0, path)) {
      path.ends_at_receiver = true;
      trace_path(context, 1, path);
    }
    // Radiance times cosine, divided by the pdf of the direction, is pi times radiance. The factor
    // 2 is needed because one of the two sides was chosen.
    const double weight = 2 * kPi / (place->pdf * static_cast<double>(chunk.photons)) *
                          opacity(scene.material(point.material), scene.textures(), point);
    const Rgb power = path.radiance * static_cast<float>(weight);
    if (luminance(power) > 0 && is_finite(power)) {
      out.items.push_back({number, power, std::holds_alternative<DiffuseBsdf>(*bsdf)});
    }
  }
  return out;
}

TracedPhotons trace_indirect_photons(const Scene& scene, const PhotonSources& sources,
                                     absl::Span<const PhotonOrigin> origins,
                                     absl::Span<const double> luminance_up_to,
                                     const PhotonChunk& chunk) {
  const PixelSampler of_origins = sampler_of_origins(chunk);
  const PixelSampler sampler = sampler_of_photons(chunk);
  // The luminance of each photon.
  const double each = luminance_up_to.back() / static_cast<double>(chunk.photons);
  const double shift = sampler.group(0, kGroupTime)[0];
  const auto origin_of = [&](std::uint64_t number) {
    const double wanted = (static_cast<double>(number) + shift) * each;
    const auto found = std::upper_bound(luminance_up_to.begin(), luminance_up_to.end() - 1, wanted);
    return static_cast<std::size_t>(found - luminance_up_to.begin());
  };
  TracedPhotons out;
  for (std::uint64_t first = chunk.first, next = first; first < chunk.last; first = next) {
    const std::size_t chosen = origin_of(first);
    ++next;
    while (next < chunk.last && origin_of(next) == chosen) {
      ++next;
    }
    const PhotonOrigin& origin = origins[chosen];
    const std::optional<Place> place = place_of(scene, sources, of_origins, origin.number);
    const Rgb power = origin.power * static_cast<float>(each / luminance(origin.power));
    // Photons that start in the same direction arrive at the same point. At this point, only the
    // first photon is stored, with the power of all. Otherwise the density of the photons would be
    // infinite, and their disks would be points.
    float share = origin.diffuse ? 1 : static_cast<float>(next - first);
    for (std::uint64_t number = first; number < next; ++number) {
      const Sample4 toward = sampler.group(number, kGroupCamera);
      const std::optional<Vec3> direction =
          origin.diffuse ? direction_from(place->normal, toward[0], toward[1]) : place->direction;
      if (direction) {
        follow(scene, sources, sampler, number, spawn_ray(place->point, *direction), power, share,
               chunk.origin, out);
      }
      share = origin.diffuse ? 1 : 0;
    }
  }
  return out;
}

}  // namespace bandsaw
