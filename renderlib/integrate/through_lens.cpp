#include "renderlib/integrate/through_lens.h"

#include <optional>

#include "renderlib/integrate/through_media.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {

void ask_through_lens(const PathContext& context, const LensView& lens, PathState& path) {
  if (context.options.technique != Technique::kBoth) {
    return;
  }
  const Receiver focus{lens.focus(), std::nullopt, path.ray.time, &lens.beyond()};
  const Lights& lights = context.scene.lights();
  if (!lights.any_for(focus)) {
    return;
  }
  path.departure = {.from = focus, .pdf = lens.pdf(path.ray.direction), .delta = false};
  const Sample4 numbers = context.numbers(kGroupTime);
  const std::optional<LightSample> light = lights.sample(focus, numbers[1], numbers[2], numbers[3]);
  if (!light || light->delta) {
    return;
  }
  const std::optional<Vec3> from = lens.on_lens(light->direction);
  if (!from) {
    return;
  }
  const Ray way{
      .origin = *from, .direction = light->target - *from, .t_max = 1, .time = path.ray.time};
  const Rgb passing = passing_light(context.scene, way, context.rays);
  const double pdf = lens.pdf(light->direction);
  const double weight = power_heuristic(light->pdf, pdf);
  path.radiance += light->radiance * passing * static_cast<float>(weight * pdf / light->pdf);
}

}  // namespace bandsaw
