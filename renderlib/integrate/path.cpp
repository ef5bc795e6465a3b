#include "renderlib/integrate/path.h"

#include <algorithm>
#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/see_through.h"
#include "renderlib/light/emission.h"
#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Where the path scattered last and how it left.
struct Departure {
  Receiver from;
  double pdf = 0;
  bool delta = true;  ///< also of the camera: lights seen from there were not asked
};

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
  if (technique == Technique::kLightsOnly) {
    return 0;
  }
  return static_cast<float>(
      power_heuristic(departure.pdf, scene.lights().pdf(departure.from, light)));
}

/// What is seen where a ray leaves the scene, as far as scattering counts for it.
Rgb background_light(const Scene& scene, const Departure& departure, const Vec3& direction,
                     Technique technique) {
  const Rgb seen = radiance(scene.background(), scene.textures(), direction);
  if (departure.delta || !scene.needs().environment || technique == Technique::kScatteringOnly) {
    return seen;
  }
  const double asked = scene.lights().environment_pdf(departure.from, direction);
  if (technique == Technique::kLightsOnly) {
    return asked > 0 ? Rgb{} : seen;  // What is even is never asked.
  }
  return seen * static_cast<float>(power_heuristic(departure.pdf, asked));
}

/// What asking and following must be weighed against each other for.
struct Asking {
  Technique technique = Technique::kBoth;
  bool only_distant_followed = false;  ///< local shading: directions end at the next surface
};

bool is_also_followed(const LightSample& light, const Asking& asking) {
  return !light.delta &&
         (asking.technique == Technique::kBoth || (asking.only_distant_followed && light.distant));
}

/// The light of one asked light that the point sends on, weighed; black when something is in
/// between.
Rgb asked_light(const Scene& scene, const SurfacePoint& point, const Receiver& receiver,
                const Bsdf& bsdf, const Sample4& numbers, const Asking& asking,
                std::uint64_t& rays) {
  // The fourth number, which surfaces do not use, gives the choice among many lights finer steps.
  const double choice = numbers[0] + numbers[3] * 0x1p-32;
  const std::optional<LightSample> light =
      scene.lights().sample(receiver, choice, numbers[1], numbers[2]);
  if (!light) {
    return {};
  }
  const BsdfValue scattered = evaluate(bsdf, light->direction);
  if (is_black(scattered.value)) {
    return {};
  }
  const Ray way = light->distant ? leave(point, light->direction) : toward(point, light->target, 0);
  const float passing = unoccluded(scene, way, rays);
  if (passing == 0) {
    return {};
  }
  const double weight =
      is_also_followed(*light, asking) ? power_heuristic(light->pdf, scattered.pdf) : 1;
  return scattered.value * light->radiance * static_cast<float>(weight / light->pdf) * passing;
}

/// What local shading sees of an environment in a direction that scattering found.
Rgb followed_environment(const Scene& scene, const SurfacePoint& point, const Departure& departure,
                         const Vec3& direction, std::uint64_t& rays) {
  const float passing = unoccluded(scene, leave(point, direction), rays);
  return passing == 0 ? Rgb{}
                      : background_light(scene, departure, direction, Technique::kBoth) * passing;
}

/// A glass that takes part in nesting.
const Dielectric* nested_glass(const Scene& scene, const Material& material) {
  const auto* glass = scene.needs().nested_glass ? std::get_if<Dielectric>(&material) : nullptr;
  return glass != nullptr && glass->priority > 0 ? glass : nullptr;
}

bool is_metal(const Material& material) { return std::holds_alternative<Metal>(material); }

}  // namespace

Rgb path_radiance(const Scene& scene, const Ray& camera_ray, const PixelSampler& sampler,
                  std::uint64_t sample, const PathOptions& options, std::uint64_t& rays) {
  const bool ask_lights = scene.needs().lights && options.technique != Technique::kScatteringOnly;
  Rgb radiance;
  Rgb throughput = gray(1);
  double compression =
      1;  // What refraction did to the throughput; roulette must not mistake it for loss.
  Ray ray = camera_ray;
  Departure departure;
  Interiors interiors;
  for (std::uint32_t depth = 0;; ++depth) {
    const std::optional<SurfacePoint> seen =
        first_surface(scene, ray, sampler, sample, depth, interiors, rays);
    if (!seen) {
      return radiance +
             throughput * background_light(scene, departure, ray.direction, options.technique);
    }
    const SurfacePoint& point = *seen;
    const Material& material = scene.material(point.material);
    const Vec3 wo = -ray.direction;
    if (const Rgb light = emitted(material, scene.textures(), point, wo); !is_black(light)) {
      radiance +=
          throughput * light * scattering_weight(scene, departure, point, options.technique);
    }
    if (std::holds_alternative<Emissive>(material)) {
      return radiance;
    }
    if (depth == options.max_depth) {
      return radiance;
    }
    const auto* nested = nested_glass(scene, material);
    const double outside_index = nested != nullptr ? interiors.index_without(point.material) : 1;
    const Bsdf bsdf = bsdf_at(material, scene.textures(), point, wo, outside_index);
    const Receiver receiver = receiver_of(point, wo);
    const bool is_last = options.local && has_density(bsdf) && !is_metal(material);
    if (ask_lights && has_density(bsdf)) {
      const Sample4 numbers = sampler.group(sample, group_light(depth));
      const Asking asking =
          is_last ? Asking{Technique::kLightsOnly, true} : Asking{options.technique, false};
      radiance += throughput * asked_light(scene, point, receiver, bsdf, numbers, asking, rays);
    }
    if (is_last) {
      const Rgb albedo = albedo_at(material, scene.textures(), point);
      radiance += throughput * albedo * scene.local_shading().ambient;
    }
    const Sample4 numbers = sampler.group(sample, group_bsdf(depth));
    const std::optional<BsdfSample> next =
        bandsaw::sample(bsdf, numbers[0], numbers[1], numbers[2]);
    if (!next) {
      return radiance;
    }
    // Lights beyond the surface were not asked.
    const bool passes = dot(next->wi, *receiver.normal) <= 0;
    departure = {receiver, next->pdf, next->delta || passes};
    if (is_last && !next->delta) {
      return scene.needs().environment
                 ? radiance + throughput * next->weight *
                                  followed_environment(scene, point, departure, next->wi, rays)
                 : radiance;
    }
    throughput *= next->weight;
    compression *= next->compression;
    if (options.russian_roulette && depth + 1 >= kRouletteDepth) {
      const double survival = std::clamp(max_component(throughput) / compression, 0.05, 1.0);
      if (numbers[3] >= survival) {
        return radiance;
      }
      throughput = throughput * static_cast<float>(1 / survival);
    }
    if (is_black(throughput)) {
      return radiance;
    }
    if (passes && nested != nullptr) {
      interiors.pass(point.material, *nested, dot(next->wi, point.geometric_normal) < 0);
    }
    ray = leave(point, next->wi);
  }
}

}  // namespace bandsaw
