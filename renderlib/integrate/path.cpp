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

/// The light of one asked light that the point sends on, weighed; black when something is in
/// between.
Rgb asked_light(const Scene& scene, const SurfacePoint& point, const Receiver& receiver,
                const Bsdf& bsdf, const Sample4& numbers, Technique technique,
                std::uint64_t& rays) {
  const std::optional<LightSample> light =
      scene.lights().sample(receiver, numbers[0], numbers[1], numbers[2]);
  if (!light) {
    return {};
  }
  const BsdfValue scattered = evaluate(bsdf, light->direction);
  if (is_black(scattered.value)) {
    return {};
  }
  const float passing = unoccluded(scene, toward(point, light->target, 0), rays);
  if (passing == 0) {
    return {};
  }
  const double weight =
      technique == Technique::kBoth ? power_heuristic(light->pdf, scattered.pdf) : 1;
  return scattered.value * light->radiance * static_cast<float>(weight / light->pdf) * passing;
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
      return radiance + throughput * bandsaw::radiance(scene.background(), ray.direction);
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
      const Technique technique = is_last ? Technique::kLightsOnly : options.technique;
      radiance += throughput * asked_light(scene, point, receiver, bsdf, numbers, technique, rays);
    }
    if (is_last) {
      const Rgb albedo = albedo_at(material, scene.textures(), point);
      radiance += throughput * albedo * scene.local_shading().ambient;
    }
    const Sample4 numbers = sampler.group(sample, group_bsdf(depth));
    const std::optional<BsdfSample> next =
        bandsaw::sample(bsdf, numbers[0], numbers[1], numbers[2]);
    if (!next || (is_last && !next->delta)) {
      return radiance;
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
    // Lights beyond the surface were not asked.
    const bool passes = dot(next->wi, receiver.normal) <= 0;
    if (passes && nested != nullptr) {
      interiors.pass(point.material, *nested, dot(next->wi, point.geometric_normal) < 0);
    }
    departure = {receiver, next->pdf, next->delta || passes};
    ray = leave(point, next->wi);
  }
}

}  // namespace bandsaw
