// A small light far beyond the plane of focus is a disk in the image, and few camera rays of a
// pixel hit the light. So a light is also sampled from the point in focus, the point of the plane
// of focus through which the camera ray passes. The line from the light through the point in focus
// crosses the lens. From the place where it crosses the lens, a shadow ray is traced to the light.
// The estimate is weighted against the camera ray by MIS.

#include "renderlib/integrate/through_lens.h"

#include <optional>

#include "renderlib/integrate/mis.h"
#include "renderlib/integrate/visibility.h"

namespace bandsaw {

void sample_light_through_lens(const PathContext& context, const LensView& lens, PathState& path) {
  if (context.options.technique != Technique::kBoth) {
    return;
  }
  const Receiver focus{lens.focus(), std::nullopt, path.ray.time, &lens.beyond()};
  const Lights& lights = context.scene.lights();
  if (!lights.any_for(focus)) {
    return;
  }
  // Because of this vertex, a light that the camera ray hits is weighted by MIS against light
  // sampling.
  path.previous = {.receiver = focus, .pdf = lens.pdf(path.ray.direction), .delta = false};
  // Number 0 of this group is the time of the ray.
  const Sample4 numbers = context.numbers(kGroupTime);
  const std::optional<LightSample> light = lights.sample(focus, numbers[1], numbers[2], numbers[3]);
  if (!light || light->delta) {
    return;
  }
  const std::optional<Vec3> on_lens = lens.on_lens(light->direction);
  if (!on_lens) {
    return;
  }
  const Ray shadow_ray{
      .origin = *on_lens, .direction = light->target - *on_lens, .t_max = 1, .time = path.ray.time};
  const Rgb passing = transmittance(
      context.scene, shadow_ray, context.stream(group_shadow(0, ShadowUse::kLens)), context.rays);
  // For rays through the point in focus, the pixel's value is the integral of the radiance times
  // the pdf of a camera ray's direction.
  const double pdf = lens.pdf(light->direction);
  const double weight = power_heuristic(light->pdf, pdf);
  path.radiance += light->radiance * passing * static_cast<float>(weight * pdf / light->pdf);
}

}  // namespace bandsaw
