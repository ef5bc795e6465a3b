// The loop over the vertices of a path, and its steps (path_steps.h): emission, light sampling,
// sampling of a direction, Russian roulette.
//
// A `Receiver` (light/receiver.h) is the point for which a light is sampled. A receiver of caustics
// (CausticRole::kReceiver) is a rough surface whose caustics come from photon maps, if there are
// any. A caster is a mirror, glass or metal that sends light to receivers of caustics (caustics.h).

#include "renderlib/integrate/path.h"

#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/guiding/portals.h"
#include "renderlib/integrate/caustics.h"
#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/integrate/mis.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/photon_start.h"
#include "renderlib/integrate/russian_roulette.h"
#include "renderlib/integrate/through_lens.h"
#include "renderlib/integrate/through_media.h"
#include "renderlib/integrate/trace_photons.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/light/emission.h"
#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

/// Returns the point as the receiver of light on the side towards `wo`.
Receiver receiver_of(const SurfacePoint& point, const Vec3& wo) {
  return {point.position, facing_normal(point, wo), point.time};
}

/// Returns the MIS weight of the emission at `light`, which the path hit from `previous`.
float emission_weight(const Scene& scene, const PreviousVertex& previous, const SurfacePoint& light,
                      Technique technique) {
  if (previous.delta || technique == Technique::kScatteringOnly) {
    return 1;
  }
  const double light_pdf = scene.lights().pdf(previous.receiver, light);
  if (technique == Technique::kLightsOnly) {
    // Light sampling never samples the far side of a sphere through its near side.
    return light_pdf > 0 ? 0 : 1;
  }
  return static_cast<float>(bsdf_sampling_weight(previous, light_pdf));
}

/// Returns the background radiance in a direction in which a ray leaves the scene, times its MIS
/// weight against light sampling of the environment and against the portals. `portals` may be null.
Rgb weighted_background(const Scene& scene, const Portals* portals, const PreviousVertex& previous,
                        const Vec3& direction, Technique technique) {
  const Rgb background = radiance(scene.background(), scene.textures(), direction);
  if (previous.delta || technique == Technique::kScatteringOnly) {
    return background;
  }
  double light_pdf = scene.background().environment
                         ? scene.lights().environment_pdf(previous.receiver, direction)
                         : 0;
  if (previous.portals && portals != nullptr) {
    light_pdf = combined_pdf(light_pdf, portals->pdf(previous.receiver.position, direction));
  }
  if (technique == Technique::kLightsOnly) {
    // Light sampling samples neither the uniform part of an environment nor directions beside the
    // portals.
    return light_pdf > 0 ? Rgb{} : background;
  }
  return background * static_cast<float>(bsdf_sampling_weight(previous, light_pdf));
}

/// The inputs of the MIS weight of light sampling at a surface. They describe the other strategies
/// that can sample the same light.
struct CompetingStrategies {
  Technique technique = Technique::kBoth;
  /// True in local shading, where a direction sampled from the BSDF finds only the environment.
  bool reaches_distant_only = false;
  /// True if light is sampled on the far side of the surface. There, directions that pass the
  /// surface have MIS weight 1, so light sampling covers only lights that such directions cannot
  /// reach.
  bool beyond_surface = false;
  /// The share that is sampled here of the light that photons carry (photons_carry()); nullopt:
  /// all.
  std::optional<Rgb> beside_photons = std::nullopt;
  /// The portals through which the background is sampled as well; null: none.
  const Portals* portals = nullptr;
};

/// Returns true if photons find the light that they carry to a caster. `casters`: the number of
/// casters that the path met before this one, since the last receiver of caustics
/// (PathState::chain).
bool is_left_to_photons(const PathContext& context, std::uint32_t casters) {
  return context.options.maps != nullptr && casters != kNoChain && casters < kMaxCausticChain;
}

/// Returns the caster that the path left, on the side of the path's ray, if photons find the light
/// that they carry to it. Photons start where light sampling at this receiver can sample a light.
std::optional<Receiver> start_of_photons(const PathContext& context, const PathState& path) {
  if (path.chain == 0 || !is_left_to_photons(context, path.chain - 1)) {
    return std::nullopt;
  }
  Receiver caster = path.previous.receiver;
  if (dot(path.ray.direction, *caster.normal) < 0) {
    caster.normal = -*caster.normal;
  }
  return caster;
}

/// Returns true if photons find the emission at `light`, which the path hit.
bool is_found_by_photons(const PathContext& context, const PathState& path,
                         const SurfacePoint& light) {
  const std::optional<Receiver> caster = start_of_photons(context, path);
  return caster && context.scene.lights().pdf(*caster, light) > 0;
}

/// Returns true if photons find the background in the direction of the path.
bool is_background_found_by_photons(const PathContext& context, const PathState& path) {
  const Lights& lights = context.scene.lights();
  const Vec3& direction = path.ray.direction;
  const std::optional<Receiver> caster = start_of_photons(context, path);
  return caster && photons_carry(lights, direction) &&
         lights.environment_pdf(*caster, direction) > 0;
}

/// Returns true if BSDF sampling alone accounts for the light on the far side of the surface.
bool is_left_to_bsdf_sampling(const LightSample& light, const CompetingStrategies& competing) {
  return competing.beyond_surface && !light.delta &&
         (!competing.reaches_distant_only || light.distant);
}

/// Returns true if BSDF sampling samples the light as well, on the near side of the surface.
bool is_also_sampled_by_bsdf(const LightSample& light, const CompetingStrategies& competing) {
  return !light.delta && !competing.beyond_surface &&
         (competing.technique == Technique::kBoth ||
          (competing.reaches_distant_only && light.distant));
}

/// Returns the light-sampling estimate of the radiance scattered at the point: samples one light,
/// traces a shadow ray to it, and applies the MIS weight. `media`: random numbers for the media
/// along the shadow ray.
Rgb sample_light(const Scene& scene, const SurfacePoint& point, const Receiver& receiver,
                 const Bsdf& bsdf, const GuidingCones& cones, const Sample4& numbers,
                 const CompetingStrategies& competing, NumberStream media, std::uint64_t& rays) {
  // The fourth number refines the selection among many lights.
  const double choice = numbers[0] + numbers[3] * 0x1p-32;
  const std::optional<LightSample> light =
      scene.lights().sample(receiver, choice, numbers[1], numbers[2]);
  if (!light || is_left_to_bsdf_sampling(*light, competing)) {
    return {};
  }
  Rgb share = gray(1);
  if (competing.beside_photons && photons_carry(scene.lights(), *light)) {
    share = *competing.beside_photons;
    if (is_black(share)) {
      return {};
    }
  }
  const BsdfValue scattered = evaluate(bsdf, cones, light->direction);
  if (is_black(scattered.value)) {
    return {};
  }
  const Rgb passing = transmittance(scene, shadow_ray_to(point, *light), media, rays);
  if (is_black(passing)) {
    return {};
  }
  double other_pdf = is_also_sampled_by_bsdf(*light, competing) ? scattered.pdf : 0;
  if (competing.portals != nullptr && light->distant && !light->delta) {
    other_pdf = combined_pdf(other_pdf, competing.portals->pdf(point.position, light->direction));
  }
  return scattered.value * light->radiance *
         static_cast<float>(power_heuristic(light->pdf, other_pdf) / light->pdf) * passing * share;
}

/// Samples the background through a portal. Returns the estimate of the light that arrives through
/// the portals on the receiver's side and is scattered at the point, with its MIS weight. `point`,
/// `receiver`, `bsdf` and `cones` are those of sample_light(). `beside_photons` is that of
/// CompetingStrategies.
Rgb sample_portals(const PathContext& context, const SurfacePoint& point, const Receiver& receiver,
                   const Bsdf& bsdf, const GuidingCones& cones,
                   const std::optional<Rgb>& beside_photons, std::uint32_t depth) {
  const Scene& scene = context.scene;
  const Sample4 numbers = context.numbers(group_portal(depth));
  const std::optional<Portals::Sample> portal =
      context.options.portals->sample(point.position, numbers[0], numbers[1], numbers[2]);
  if (!portal || !(dot(portal->direction, *receiver.normal) > 0)) {
    return {};
  }
  const BsdfValue scattered = evaluate(bsdf, cones, portal->direction);
  Rgb background = radiance(scene.background(), scene.textures(), portal->direction);
  if (beside_photons && photons_carry(scene.lights(), portal->direction)) {
    background *= *beside_photons;
  }
  if (is_black(scattered.value) || is_black(background)) {
    return {};
  }
  const Rgb passing = transmittance(scene, spawn_ray(point, portal->direction),
                                    context.stream(group_portal(depth)), context.rays);
  if (is_black(passing)) {
    return {};
  }
  double other_pdf = context.options.technique == Technique::kBoth ? scattered.pdf : 0;
  if (scene.background().environment) {
    other_pdf =
        combined_pdf(other_pdf, scene.lights().environment_pdf(receiver, portal->direction));
  }
  return scattered.value * background *
         static_cast<float>(power_heuristic(portal->pdf, other_pdf) / portal->pdf) * passing;
}

/// Returns the environment's radiance in a direction that local shading sampled from the BSDF, with
/// its MIS weight and the transmittance of the ray.
Rgb environment_along(const Scene& scene, const SurfacePoint& point, const PreviousVertex& previous,
                      const Vec3& direction, NumberStream media, std::uint64_t& rays) {
  const Rgb passing = transmittance(scene, spawn_ray(point, direction), media, rays);
  return is_black(passing)
             ? Rgb{}
             : weighted_background(scene, nullptr, previous, direction, Technique::kBoth) * passing;
}

bool is_metal(const Material& material) {
  return std::holds_alternative<Metal>(material.kind) ||
         std::holds_alternative<Conductor>(material.kind);
}

/// Returns true for a pane that light passes even after the last scattering that counts.
bool has_free_passage(const Material& material) {
  const auto* pane = std::get_if<ThinDielectric>(&material.kind);
  return pane != nullptr && pane->free_passage;
}

/// Counts a sampled scattering. Returns false, and marks the path as truncated, if `max_depth`
/// forbids it. After kMaxUncounted scatterings that do not count towards `max_depth`, the next
/// scattering that does not count is forbidden too.
bool count(const PathContext& context, const BsdfSample& next, std::uint32_t depth,
           PathState& path) {
  const bool ends = next.counts ? context.is_at_end(path, depth) : path.uncounted == kMaxUncounted;
  path.uncounted += next.counts || ends ? 0 : 1;
  path.truncated = path.truncated || ends;
  return !ends;
}

/// Continues from a surface, as scattering `depth`, in all directions into which the path is split.
void trace_branches(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
                    const GuidingCones& cones, std::uint32_t depth, PathState& path) {
  Rgb sum;
  for (std::uint32_t i = 0; i < context.branches; ++i) {
    const PathContext of_branch = context.branch(i);
    PathState branch = path;
    branch.radiance = {};
    if (scatter(of_branch, point, bsdf, cones, depth, branch)) {
      trace_path(of_branch, depth + 1, branch);
    }
    sum += branch.radiance;
    path.truncated |= branch.truncated;
  }
  path.radiance += sum * (1 / static_cast<float>(context.branches));
}

}  // namespace

std::uint32_t branches_for(const Scene& scene) {
  if (!scene.lights().empty()) {
    return 1;
  }
  return scene.geometry().meshes.empty() ? 2 : 4;
}

void add_emission(const PathContext& context, const SurfacePoint& point, std::uint32_t depth,
                  PathState& path) {
  const Scene& scene = context.scene;
  Rgb light = emitted(scene.material(point.material), scene.textures(), point, -path.ray.direction);
  if (!is_black(light) && is_found_by_photons(context, path, point)) {
    light *= path.share_of_paths;
  }
  if (is_black(light)) {
    return;
  }
  Rgb passing = gray(1);
  if (scene.features().media) {
    Ray up_to_light = path.ray;
    up_to_light.t_max = distance_along(up_to_light, point);
    passing = media_transmittance(scene, up_to_light,
                                  context.stream(group_shadow(depth, ShadowUse::kEmission)),
                                  context.rays);
  }
  path.radiance += path.throughput * light * passing *
                   emission_weight(scene, path.previous, point, context.options.technique);
}

void add_background(const PathContext& context, PathState& path) {
  const Rgb share = is_background_found_by_photons(context, path) ? path.share_of_paths : gray(1);
  if (is_black(share)) {
    return;
  }
  path.radiance += path.throughput * share *
                   weighted_background(context.scene, context.options.portals, path.previous,
                                       path.ray.direction, context.options.technique);
}

std::optional<Bsdf> make_bsdf(const PathContext& context, const SurfacePoint& point,
                              std::uint32_t depth, PathState& path) {
  const Scene& scene = context.scene;
  const Material& material = scene.material(point.material);
  const Vec3 wo = -path.ray.direction;
  if (std::holds_alternative<Emissive>(material.kind)) {
    return std::nullopt;
  }
  if (context.is_at_end(path, depth) && !has_free_passage(material)) {
    path.truncated = true;
    return std::nullopt;
  }
  double outside_index = 1;
  if (nested_glass(material) != nullptr) {
    const bool enters = dot(wo, point.geometric_normal) >= 0;
    const Interiors& outside = enters ? path.nesting.here : path.nesting.beyond;
    outside_index = outside.index_without(point.material);
  }
  return bsdf_at(material, scene.textures(), point, wo, outside_index);
}

/// Returns the light of the caustics in `maps` that a receiver scatters along the path. If the path
/// has met another receiver before, only every second sample of a pixel looks up the map, and the
/// light of the map counts twice. The reason is that caustics are a small part of the light beyond
/// the first receiver, and a look-up takes longer than the rest of the scattering.
Rgb caustics_at(const PathContext& context, const TracedMaps& maps, const SurfacePoint& point,
                CausticRole role, const Bsdf& bsdf, std::uint32_t depth, const PathState& path) {
  constexpr std::uint64_t kSamplesPerLookUp = 2;
  std::uint64_t counts = 1;
  if (path.after_receiver) {
    // For each pixel and depth, a random number selects the samples that look up the map.
    const double first = context.sampler.stream(0, group_bsdf(depth)).next() * kSamplesPerLookUp;
    if ((context.sample + static_cast<std::uint64_t>(first)) % kSamplesPerLookUp != 0) {
      return {};
    }
    counts = kSamplesPerLookUp;
  }
  PhotonFilter filter{.longest = context.scatterings_left(path, depth)};
  if (maps.parts > 1) {
    filter.part = part_of_shutter(context.scene, maps.parts, point.time);
  }
  return photon_radiance(maps.caustics, point, role, bsdf, -path.ray.direction, filter) *
         static_cast<float>(counts * maps.parts);
}

/// Adds the light of photon maps that a receiver scatters along the path. Returns true if the added
/// light includes all indirect light, so that the path ends at the next receiver without narrow
/// lobes (kReceiver).
bool add_photons(const PathContext& context, const SurfacePoint& point, CausticRole role,
                 const Bsdf& bsdf, std::uint32_t depth, PathState& path) {
  const TracedMaps& maps = context.options.maps->of_sample(context.sample);
  if (maps.caustics.size() > 0) {
    path.radiance += path.throughput * caustics_at(context, maps, point, role, bsdf, depth, path);
  }
  if (role != CausticRole::kReceiver || !path.after_receiver || maps.indirect.size() == 0 ||
      path.reach < maps.gather_distance) {
    return false;
  }
  path.radiance +=
      path.throughput * photon_radiance(maps.indirect, point, role, bsdf, -path.ray.direction,
                                        {.longest = context.scatterings_left(path, depth)});
  return true;
}

bool scatter(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
             const GuidingCones& cones, std::uint32_t depth, PathState& path) {
  const Scene& scene = context.scene;
  const PathOptions& options = context.options;
  const Material& material = scene.material(point.material);
  const Receiver receiver = receiver_of(point, -path.ray.direction);
  const Receiver behind{point.position, -*receiver.normal, point.time};
  // Where much light arrives from behind, lights are sampled in the same way on both sides.
  const bool both_sides = is_diffuse_behind(bsdf);
  // In local shading, the path ends at such a surface. The sampled direction only collects the
  // environment.
  const bool is_last = options.local && has_pdf(bsdf) && !is_metal(material);
  const CausticRole role = options.maps == nullptr
                               ? CausticRole::kOther
                               : caustic_role(options.maps->casters(), point, point.material, bsdf);
  bool gathers = false;
  if (options.maps != nullptr) {
    if (role == CausticRole::kReceiver && path.ends_at_receiver) {
      return false;
    }
    path.reach += length(point.position - path.ray.origin);
    gathers = receives_caustics(role) && add_photons(context, point, role, bsdf, depth, path);
  }

  const Portals* const portals =
      has_pdf(bsdf) && options.technique != Technique::kScatteringOnly ? options.portals : nullptr;
  std::optional<Rgb> beside_photons;
  if (role == CausticRole::kCaster && is_left_to_photons(context, path.chain)) {
    beside_photons = path.share_of_paths;
  }
  // Sample a light on the side from which the path came. If the surface passes light, a light on
  // the far side is sampled too, provided that both sides are treated alike or that only light
  // sampling reaches some lights.
  if (context.samples_lights() && has_pdf(bsdf)) {
    const Sample4 numbers = context.numbers(group_light(depth));
    CompetingStrategies competing =
        is_last ? CompetingStrategies{Technique::kLightsOnly, /*reaches_distant_only=*/true}
                : CompetingStrategies{options.technique, /*reaches_distant_only=*/false};
    competing.portals = portals;
    competing.beside_photons = beside_photons;
    path.radiance +=
        path.throughput * sample_light(scene, point, receiver, bsdf, cones, numbers, competing,
                                       context.stream(group_shadow(depth, ShadowUse::kLight)),
                                       context.rays);
    if (has_pdf_behind(bsdf) && (both_sides || is_last || scene.lights().any_delta())) {
      competing.beyond_surface = !both_sides;
      competing.portals = nullptr;
      path.radiance +=
          path.throughput *
          sample_light(scene, point, behind, bsdf, cones, numbers, competing,
                       context.stream(group_shadow(depth, ShadowUse::kLightBehind)), context.rays);
    }
  }
  if (portals != nullptr) {
    path.radiance += path.throughput *
                     sample_portals(context, point, receiver, bsdf, cones, beside_photons, depth);
  }
  if (is_last) {
    const Rgb albedo = albedo_at(material, scene.textures(), point);
    path.radiance += path.throughput * albedo * scene.local_shading().ambient;
  }

  // BSDF sampling, guided where there is a field.
  const Sample4 numbers = context.numbers(group_bsdf(depth));
  const std::optional<GuidedSample> guided =
      sample(bsdf, cones, numbers[0], numbers[1], numbers[2]);
  if (!guided || !count(context, guided->next, depth, path)) {
    return false;
  }
  const BsdfSample* const next = &guided->next;
  // Unless light sampling covered both sides, transmitted directions keep MIS weight 1.
  const bool passes = dot(next->wi, *receiver.normal) <= 0;
  path.previous = {passes && both_sides ? behind : receiver, next->pdf,
                   next->delta || (passes && !both_sides)};
  path.previous.portals = portals != nullptr && !passes;
  path.throughput *= next->weight;
  const bool receives = receives_caustics(role) && !next->delta;
  if (receives) {
    path.share_of_paths = share_of_paths(role, bsdf, next->wi);
  }
  path.chain = receives                                                 ? 0
               : role == CausticRole::kCaster && path.chain != kNoChain ? path.chain + 1
                                                                        : kNoChain;
  if (role == CausticRole::kReceiver && !next->delta) {
    path.after_receiver = true;
    path.reach = 0;
    path.ends_at_receiver = gathers;
  }
  if (is_last && !next->delta) {
    if (scene.background().environment) {
      path.radiance +=
          path.throughput *
          environment_along(scene, point, path.previous, next->wi,
                            context.stream(group_shadow(depth, ShadowUse::kEnvironment)),
                            context.rays);
    }
    return false;
  }
  path.compression *= next->compression * guided->scaling;
  if (!survives_roulette(context, depth, numbers[3], path)) {
    return false;
  }
  if (passes && nested_glass(material) != nullptr) {
    path.nesting.here = path.nesting.beyond;
  }
  path.ray = spawn_ray(point, next->wi);
  return true;
}

void trace_path(const PathContext& context, std::uint32_t depth, PathState& path) {
  for (;; ++depth) {
    // Find the first visible surface along the ray.
    const std::optional<SurfacePoint> hit = next_surface(context, depth, path);
    // Add its emission, weighted against light sampling at the previous vertex.
    if (hit) {
      add_emission(context, *hit, depth, path);
    }
    // Sample light in the media before the surface. The path may scatter there and continue from a
    // point in a medium.
    if (context.scene.features().media) {
      const double length = hit ? distance_along(path.ray, *hit) : kInfinity;
      const MediumEvent event = through_media(context, length, depth, path);
      if (event == MediumEvent::kEnded) {
        return;
      }
      if (event == MediumEvent::kScattered) {
        path.chain = kNoChain;
        continue;
      }
    }
    // Add the background where the ray leaves the scene.
    if (!hit) {
      add_background(context, path);
      return;
    }
    // A hidden lamp does not stop light, and light sampling ignores it as well. Passing it is no
    // scattering that counts.
    if (context.scene.features().alpha && is_hidden_lamp(context.scene.material(hit->material))) {
      path.uncounted += path.uncounted < kMaxUncounted ? 1 : 0;
      path.ray = spawn_ray(*hit, path.ray.direction);
      continue;
    }
    // Evaluate the material. Emitters do not scatter, and paths end at the maximum depth.
    const std::optional<Bsdf> bsdf = make_bsdf(context, *hit, depth, path);
    if (!bsdf) {
      return;
    }
    const GuidingCones cones = cones_at(context, *hit, *bsdf, -path.ray.direction);
    // Split the path at the first surface with a pdf, if the options require it.
    if (context.branches > 1 && has_pdf(*bsdf)) {
      trace_branches(context, *hit, *bsdf, cones, depth, path);
      return;
    }
    // Sample a light, then a direction from the BSDF; Russian roulette may end the path.
    if (!scatter(context, *hit, *bsdf, cones, depth, path)) {
      return;
    }
  }
}

Rgb path_radiance(const Scene& scene, const CameraRay& camera_ray, const PixelSampler& sampler,
                  std::uint64_t sample, const PathOptions& options, PathCounts& counts) {
  const PathContext context{scene, sampler, sample, options, counts.rays, options.branches};
  PathState path(camera_ray.ray);
  if (camera_ray.lens) {
    sample_light_through_lens(context, *camera_ray.lens, path);
  }
  trace_path(context, 0, path);
  counts.truncated += path.truncated ? 1 : 0;
  return path.radiance;
}

}  // namespace bandsaw
