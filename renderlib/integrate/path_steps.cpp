#include "renderlib/integrate/path_steps.h"

#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/medium_walk.h"
#include "renderlib/integrate/see_through.h"
#include "renderlib/integrate/through_media.h"
#include "renderlib/light/emission.h"
#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

Receiver receiver_of(const SurfacePoint& point, const Vec3& wo) {
  const bool outside = dot(wo, point.geometric_normal) >= 0;
  return {point.position, outside ? point.geometric_normal : -point.geometric_normal, point.time};
}

/// How much of the emission that scattering found counts.
float scattering_weight(const Scene& scene, const Departure& departure, const SurfacePoint& light,
                        Technique technique) {
  if (departure.delta || technique == Technique::kScatteringOnly) {
    return 1;
  }
  const double asked = scene.lights().pdf(departure.from, light);
  if (technique == Technique::kLightsOnly) {
    return asked > 0 ? 0 : 1;  // The far side of a sphere, through its near one, is never asked.
  }
  return static_cast<float>(power_heuristic(departure.pdf, asked * departure.asked));
}

/// What is seen where a ray leaves the scene, as far as scattering counts for it.
Rgb background_light(const Scene& scene, const Departure& departure, const Vec3& direction,
                     Technique technique) {
  const Rgb seen = radiance(scene.background(), scene.textures(), direction);
  if (departure.delta || !scene.background().environment ||
      technique == Technique::kScatteringOnly) {
    return seen;
  }
  const double asked = scene.lights().environment_pdf(departure.from, direction);
  if (technique == Technique::kLightsOnly) {
    return asked > 0 ? Rgb{} : seen;  // What is even is never asked.
  }
  return seen * static_cast<float>(power_heuristic(departure.pdf, asked * departure.asked));
}

/// What asking and following must be weighed against each other for.
struct Asking {
  Technique technique = Technique::kBoth;
  bool only_distant_followed = false;  ///< local shading: directions end at the next surface
  bool behind = false;  ///< through the surface: only what no direction that passes it may find
};

Asking through(Asking asking) {
  asking.behind = true;
  return asking;
}

bool is_found_behind(const LightSample& light, const Asking& asking) {
  return !light.delta && (!asking.only_distant_followed || light.distant);
}

bool is_also_followed(const LightSample& light, const Asking& asking) {
  return !light.delta && !asking.behind &&
         (asking.technique == Technique::kBoth || (asking.only_distant_followed && light.distant));
}

/// The light of one asked light that the point sends on, weighed; black when something is in
/// between.
Rgb asked_light(const Scene& scene, const SurfacePoint& point, const Receiver& receiver,
                const Bsdf& bsdf, const Sample4& numbers, const Asking& asking,
                std::uint64_t& rays) {
  // The fourth number gives the choice among many lights finer steps.
  const double choice = numbers[0] + numbers[3] * 0x1p-32;
  const std::optional<LightSample> light =
      scene.lights().sample(receiver, choice, numbers[1], numbers[2]);
  if (!light || (asking.behind && is_found_behind(*light, asking))) {
    return {};
  }
  const BsdfValue scattered = evaluate(bsdf, light->direction);
  if (is_black(scattered.value)) {
    return {};
  }
  const Ray way =
      light->distant ? spawn_ray(point, light->direction) : spawn_ray_to(point, light->target, 0);
  const Rgb passing = passing_light(scene, way, rays);
  if (is_black(passing)) {
    return {};
  }
  const double weight =
      is_also_followed(*light, asking) ? power_heuristic(light->pdf, scattered.pdf) : 1;
  return scattered.value * light->radiance * static_cast<float>(weight / light->pdf) * passing;
}

/// What local shading sees of an environment in a direction that scattering found.
Rgb followed_environment(const Scene& scene, const SurfacePoint& point, const Departure& departure,
                         const Vec3& direction, std::uint64_t& rays) {
  const Rgb passing = passing_light(scene, spawn_ray(point, direction), rays);
  return is_black(passing)
             ? Rgb{}
             : background_light(scene, departure, direction, Technique::kBoth) * passing;
}

bool is_metal(const Material& material) { return std::holds_alternative<Metal>(material); }

}  // namespace

void see_surface(const PathContext& context, const SurfacePoint& point, PathState& path) {
  const Scene& scene = context.scene;
  const Rgb light =
      emitted(scene.material(point.material), scene.textures(), point, -path.ray.direction);
  if (is_black(light)) {
    return;
  }
  Rgb passing = gray(1);
  if (scene.features().media) {
    Ray way = path.ray;
    way.t_max = distance_along(way, point);
    passing = media_transmittance(scene, way, context.rays);
  }
  path.radiance += path.throughput * light * passing *
                   scattering_weight(scene, path.departure, point, context.options.technique);
}

std::optional<Bsdf> arrive(const PathContext& context, const SurfacePoint& point,
                           std::uint32_t depth, PathState& path) {
  const Scene& scene = context.scene;
  const Material& material = scene.material(point.material);
  const Vec3 wo = -path.ray.direction;
  if (std::holds_alternative<Emissive>(material)) {
    return std::nullopt;
  }
  if (depth == context.options.max_depth) {
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

bool scatter(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
             std::uint32_t depth, PathState& path) {
  const Scene& scene = context.scene;
  const PathOptions& options = context.options;
  const Material& material = scene.material(point.material);
  const Receiver receiver = receiver_of(point, -path.ray.direction);
  const bool is_last = options.local && has_density(bsdf) && !is_metal(material);
  if (context.asks_lights() && has_density(bsdf)) {
    const Sample4 numbers = context.numbers(group_light(depth));
    const Asking asking =
        is_last ? Asking{Technique::kLightsOnly, true} : Asking{options.technique, false};
    path.radiance +=
        path.throughput * asked_light(scene, point, receiver, bsdf, numbers, asking, context.rays);
    if (has_density_behind(bsdf) && (is_last || scene.lights().any_delta())) {
      const Receiver behind{point.position, -*receiver.normal, point.time};
      path.radiance += path.throughput * asked_light(scene, point, behind, bsdf, numbers,
                                                     through(asking), context.rays);
    }
  }
  if (is_last) {
    const Rgb albedo = albedo_at(material, scene.textures(), point);
    path.radiance += path.throughput * albedo * scene.local_shading().ambient;
  }
  const Sample4 numbers = context.numbers(group_bsdf(depth));
  const std::optional<BsdfSample> next = sample(bsdf, numbers[0], numbers[1], numbers[2]);
  if (!next) {
    return false;
  }
  // Lights beyond the surface that a direction can find were not asked.
  const bool passes = dot(next->wi, *receiver.normal) <= 0;
  path.departure = {receiver, next->pdf, next->delta || passes};
  path.throughput *= next->weight;
  if (is_last && !next->delta) {
    if (scene.background().environment) {
      path.radiance += path.throughput *
                       followed_environment(scene, point, path.departure, next->wi, context.rays);
    }
    return false;
  }
  path.compression *= next->compression;
  if (!survives(context, depth, numbers[3], path)) {
    return false;
  }
  if (passes && nested_glass(material) != nullptr) {
    path.nesting.here = path.nesting.beyond;
  }
  path.ray = spawn_ray(point, next->wi);
  return true;
}

void leave_scene(const PathContext& context, PathState& path) {
  path.radiance +=
      path.throughput * background_light(context.scene, path.departure, path.ray.direction,
                                         context.options.technique);
}

}  // namespace bandsaw
