// Photons are paths that begin at a caster, a surface of metal or glass that may cast a caustic. A
// random point of a caster is chosen, a light is sampled from this point, and the direction of the
// photon is sampled from the BSDF of the caster. Where a photon arrives at a surface whose
// directions can be guided, a record says from where it came and how much power it had.

#include "renderlib/integrate/training_photons.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/guided_bsdf.h"
#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/photon_start.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {
namespace {

/// A photon that has left a caster.
struct Photon {
  Ray ray;
  double power = 0;        ///< a luminance
  SurfacePoint from;       ///< where the ray starts
  double solid_angle = 0;  ///< GuidingRecord::solid_angle
};

/// Scatters the photon, which comes from direction `wo`, at the surface. Returns false if it is
/// absorbed.
bool scatter_photon(const Scene& scene, const SurfacePoint& point, const Vec3& wo,
                    const Sample4& numbers, Photon& photon) {
  const Bsdf bsdf = bsdf_at(scene.material(point.material), scene.textures(), point, wo);
  const std::optional<BsdfSample> next = sample(bsdf, numbers[0], numbers[1], numbers[2]);
  if (!next) {
    return false;
  }
  // Power is not compressed by refraction, in contrast to radiance.
  photon.power *= luminance(next->weight) / next->compression;
  photon.solid_angle = next->delta ? photon.solid_angle : 0;
  photon.ray = spawn_ray(point, next->wi);
  photon.from = point;
  return photon.power > 0 && std::isfinite(photon.power);
}

/// Returns the photon that leaves a random point of a caster; std::nullopt if no light reaches the
/// point or the photon is absorbed.
std::optional<Photon> start(const Scene& scene, const Casters& casters, const PixelSampler& sampler,
                            std::uint64_t sample, TrainingRecords& out) {
  const std::optional<PhotonStart> at = start_photon(scene, casters, sampler, sample);
  if (!at) {
    return std::nullopt;
  }
  const LightSample& light = at->light;
  const double passing = visibility(scene, shadow_ray_to(at->point, light), out.rays);
  Photon photon;
  photon.solid_angle = light.delta ? 0 : 1 / light.pdf;
  // The factor 2 is needed because one of the two sides of the caster was chosen.
  photon.power = 2 * passing * luminance(light.radiance) / light.pdf *
                 std::abs(dot(light.direction, at->normal)) / at->pdf;
  if (!(photon.power > 0) || !scatter_photon(scene, at->point, light.direction,
                                             sampler.group(sample, group_bsdf(0)), photon)) {
    return std::nullopt;
  }
  return photon;
}

/// Follows the photon until it arrives at a surface whose directions can be guided, and adds a
/// record for this arrival. The photon ends without a record once it was scattered `longest` times.
/// `photons` is the number of photons that share the power. If `mapped` is true, photon maps find
/// the light that arrives at receivers of caustics, so arrivals there are not recorded.
void follow(const Scene& scene, const PixelSampler& sampler, std::uint64_t sample,
            std::uint32_t longest, double photons, bool mapped, Photon photon,
            TrainingRecords& out) {
  NestedDielectrics nesting;
  for (std::uint32_t depth = 1; depth < longest; ++depth) {
    const std::optional<SurfacePoint> hit =
        intersect_visible(scene, photon.ray, sampler, sample, depth, nesting, out.rays);
    if (!hit || std::holds_alternative<Emissive>(scene.material(hit->material).kind)) {
      return;
    }
    const Vec3 wo = -photon.ray.direction;
    const Bsdf bsdf = bsdf_at(scene.material(hit->material), scene.textures(), *hit, wo);
    if (mapped && receives_caustics(role_of_receiver(bsdf))) {
      return;
    }
    if (can_be_guided(bsdf)) {
      out.items.push_back({.position = float3(hit->position),
                           .normal = float3(facing_normal(*hit, wo)),
                           .source = float3(photon.from.position),
                           .weight = static_cast<float>(photon.power / photons),
                           .kind = GuidingRecord::Kind::kPhoton,
                           .solid_angle = static_cast<float>(photon.solid_angle)});
      return;
    }
    if (!scatter_photon(scene, *hit, wo, sampler.group(sample, group_bsdf(depth)), photon)) {
      return;
    }
  }
}

}  // namespace

TrainingRecords training_photons(const Scene& scene, const Casters& casters, const GuidingKey& key,
                                 const TrainingChunk& chunk, std::uint64_t photons, bool mapped) {
  const PixelSampler sampler = training_sampler(chunk);
  const std::uint32_t longest = std::min(kMaxCausticChain, key.max_depth);
  TrainingRecords out;
  for (std::uint64_t sample = 0; sample < chunk.count; ++sample) {
    if (const std::optional<Photon> photon = start(scene, casters, sampler, sample, out)) {
      follow(scene, sampler, sample, longest, static_cast<double>(photons), mapped, *photon, out);
    }
  }
  return out;
}

}  // namespace bandsaw
