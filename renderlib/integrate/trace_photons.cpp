// A photon starts at a caster (a surface of metal or glass that may cast a caustic) with the light
// of a lamp, is scattered at casters, and is stored at the first receiver of caustics that it
// meets. share_on_surface() measures with short rays how much of a photon's disk lies on surfaces.

#include "renderlib/integrate/trace_photons.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>

#include "renderlib/base/split_mix.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/integrate/scatter_photon.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/light/shape_light.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/mixture.h"
#include "renderlib/material/opacity.h"
#include "renderlib/math/elementary.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/sampler.h"

namespace bandsaw {
namespace {

/// A photon that has left a caster.
struct Photon {
  Ray ray;
  Rgb power;
  double angle = 0;  ///< solid angle of the lamp as seen from the first caster; 0 for a delta light
};

/// The random numbers of a photon.
struct Numbers {
  const PixelSampler& sampler;
  std::uint64_t photon;
  Sample4 group(std::uint32_t number) const { return sampler.group(photon, number); }
  NumberStream stream(std::uint32_t depth) const {
    return sampler.stream(photon, group_shadow(depth, ShadowUse::kLight));
  }
};

/// Scatters the photon, which comes from direction `in`, at the point of a caster. Returns false if
/// the photon is absorbed.
bool scatter(const Scene& scene, const SurfacePoint& point, const Vec3& in, const Sample4& numbers,
             Photon& photon) {
  const std::optional<PhotonScattering> next = scatter_photon(scene, point, in, numbers);
  if (!next) {
    return false;
  }
  photon.power = photon.power * next->factor;
  photon.ray = spawn_ray(point, next->out);
  return max_component(photon.power) > 0 && is_finite(photon.power);
}

/// Returns the probability that a hit of a surface of material `id` is a hit of a receiver of
/// caustics. `from` is the direction from which the photon comes. For a receiver the probability is
/// the opacity at the point, and for other materials 0. For a mixture it is the mean over both
/// parts, weighted by their amounts.
double receiving_part(const Scene& scene, const Casters& casters, MaterialId id,
                      const SurfacePoint& point, const Vec3& from) {
  const Material& material = scene.material(id);
  if (const auto* mix = std::get_if<Mix>(&material.kind)) {
    const double amount = amount_at(*mix, scene.textures(), point);
    return (1 - amount) * receiving_part(scene, casters, mix->a, point, from) +
           amount * receiving_part(scene, casters, mix->b, point, from);
  }
  const Bsdf bsdf = bsdf_at(material, scene.textures(), point, from);
  return receives_caustics(caustic_role(casters, point, id, bsdf))
             ? opacity(material, scene.textures(), point)
             : 0;
}

/// Returns the photon that leaves a random point of a caster; std::nullopt if no light that
/// photons carry arrives at the point, or the photon is absorbed. `photons`: number of photons that
/// share the power.
std::optional<Photon> start(const Scene& scene, const Casters& casters, const Numbers& numbers,
                            std::uint64_t photons, std::uint64_t& rays) {
  std::optional<PhotonStart> at = start_photon(scene, casters, numbers.sampler, numbers.photon);
  if (!at || !photons_carry(scene.lights(), at->light)) {
    return std::nullopt;
  }
  const LightSample& light = at->light;
  SurfacePoint& point = at->point;
  add_directions(scene, point);
  const double cosine = dot(light.direction, at->normal);
  if (!(cosine > 0)) {
    return std::nullopt;
  }
  const Rgb passing = transmittance(scene, shadow_ray_to(point, light), numbers.stream(0), rays);
  // The factor 2 is needed because one of the two sides of the caster was chosen.
  const double weight = 2 * cosine / (light.pdf * at->pdf * static_cast<double>(photons)) *
                        opacity(scene.material(point.material), scene.textures(), point);
  Photon photon{.ray = {},
                .power = light.radiance * passing * static_cast<float>(weight),
                .angle = light.delta ? 0 : 1 / light.pdf};
  if (!(max_component(photon.power) > 0) ||
      !scatter(scene, point, light.direction, numbers.group(group_bsdf(0)), photon)) {
    return std::nullopt;
  }
  return photon;
}

/// Follows the photon until it arrives at a receiver of caustics, and adds it to `out`.
void follow(const Scene& scene, const Casters& casters, const Numbers& numbers, Photon photon,
            const PhotonChunk& chunk, TracedPhotons& out) {
  NestedDielectrics nesting;
  for (std::uint32_t chain = 1; chain <= kMaxCausticChain; ++chain) {
    const std::optional<SurfacePoint> hit = intersect_visible(
        scene, photon.ray, numbers.sampler, numbers.photon, chain, nesting, out.rays);
    if (!hit || std::holds_alternative<Emissive>(scene.material(hit->material).kind)) {
      return;
    }
    if (scene.features().media) {
      Ray up_to_hit = photon.ray;
      up_to_hit.t_max = distance_along(photon.ray, *hit);
      photon.power *= media_transmittance(scene, up_to_hit, numbers.stream(chain), out.rays);
      if (!(max_component(photon.power) > 0)) {
        return;
      }
    }
    const Vec3 from = -photon.ray.direction;
    const CausticRole role =
        caustic_role(casters, *hit, hit->material,
                     bsdf_at(scene.material(hit->material), scene.textures(), *hit, from));
    if (receives_caustics(role)) {
      out.photons.push_back(
          stored_photon(scene, casters, *hit, from, chain, photon.power, chunk.origin));
      out.photons.back().part = part_of_shutter(scene, chunk.parts, hit->time);
      const double power = luminance(out.photons.back().power);
      out.power += power;
      out.power_by_angle += power * photon.angle;
      return;
    }
    if (role != CausticRole::kCaster ||
        !scatter(scene, *hit, from, numbers.group(group_bsdf(chain)), photon)) {
      return;
    }
  }
}

/// Returns true if a surface lies close to the point `to` of the photon's disk, and nothing opaque
/// stands between this point and the centre of the disk. Close means at most a quarter of the
/// radius below the disk's plane: lower surfaces do not get the photon's light (density_at() in
/// guiding/photon_map.h). `centre`: the centre of the disk in the world.
bool is_on_surface(const Scene& scene, const StoredPhoton& photon, const Vec3& centre,
                   const Vec3& to) {
  const Vec3 lift = vec3(photon.normal) * (photon.radius / 8.0);
  const Vec3 start = centre + lift;
  const double time = middle_of(shutter_of(scene.camera()));
  const Ray along{.origin = start, .direction = to + lift - start, .t_max = 1, .time = time};
  const Ray down{.origin = to + lift, .direction = lift * -3, .t_max = 1, .time = time};
  std::uint64_t rays = 0;
  return visibility(scene, along, rays) > 0 && visibility(scene, down, rays) < 1;
}

/// Returns a number in [0, 1) that depends on the photon's position alone.
double random_number_of(const StoredPhoton& photon) {
  std::uint64_t bits = 0;
  for (const float coordinate : photon.position) {
    bits = split_mix(bits ^ std::bit_cast<std::uint32_t>(coordinate));
  }
  return NumberStream(bits).next();
}

}  // namespace

StoredPhoton stored_photon(const Scene& scene, const Casters& casters, const SurfacePoint& hit,
                           const Vec3& from, std::uint32_t chain, Rgb power, const Vec3& origin) {
  if (scene.features().alpha || scene.features().mixtures) {
    const MaterialId whole = material_of(scene.geometry(), hit.id);
    power = power * static_cast<float>(1 / receiving_part(scene, casters, whole, hit, from));
  }
  return {.position = float3(hit.position - origin),
          .normal = float3(facing_normal(hit, from)),
          .chain = static_cast<std::uint16_t>(chain),
          .from = float3(from),
          .power = power};
}

TracedPhotons trace_photons(const Scene& scene, const Casters& casters, const PhotonChunk& chunk) {
  const PixelSampler sampler(chunk.seed, kBeyondImages, kBeyondImages + chunk.map);
  TracedPhotons out;
  for (std::uint64_t number = chunk.first; number < chunk.last; ++number) {
    const Numbers numbers{sampler, number};
    if (const auto photon = start(scene, casters, numbers, chunk.photons, out.rays)) {
      follow(scene, casters, numbers, *photon, chunk, out);
    }
  }
  return out;
}

double share_on_surface(const Scene& scene, const StoredPhoton& photon, const Vec3& origin) {
  constexpr int kAtRim = 4;      // points at the rim of the disk
  constexpr double kRim = 0.97;  // their distance, as a part of the radius
  constexpr int kAllOver = 16;   // points all over the disk
  // Minimum number of points that count as found. Obstacles such as blades of grass hide points
  // that get the photon's light nevertheless (density_at() in guiding/photon_map.h), so too few
  // points may be found. The minimum is a quarter, because at a corner of two edges a quarter of
  // the disk is left.
  constexpr int kFewest = kAllOver / 4;
  constexpr double kGoldenTurn = 0.381966011250105;  // the golden angle, as a part of a turn
  const Vec3 centre = origin + vec3(photon.position);
  const Basis basis = orthonormal_basis(vec3(photon.normal));
  // The points of each disk are turned by a different angle, so that edges which are parallel to an
  // axis of the world are not missed.
  const double first_turn = random_number_of(photon);
  const auto is_there = [&](double turn, double distance) {
    const SinCos angle = sincos_turns(turn + first_turn);
    return is_on_surface(
        scene, photon, centre,
        centre + basis.x * (distance * angle.cos) + basis.y * (distance * angle.sin));
  };
  int found = 0;
  for (int i = 0; i < kAtRim; ++i) {
    found += is_there(i / double{kAtRim}, kRim * photon.radius) ? 1 : 0;
  }
  if (found == kAtRim) {
    return 1;
  }
  // The points lie on a spiral. Their density is Epanechnikov's kernel, by which the photon spreads
  // its power. `inside` is the part of the power that falls within `distance`.
  found = 0;
  for (int i = 0; i < kAllOver; ++i) {
    const double inside = (i + 0.5) / kAllOver;
    const double distance = std::sqrt(1 - std::sqrt(1 - inside));
    found += is_there(i * kGoldenTurn, distance * photon.radius) ? 1 : 0;
  }
  return std::max(kFewest, found) / static_cast<double>(kAllOver);
}

}  // namespace bandsaw
