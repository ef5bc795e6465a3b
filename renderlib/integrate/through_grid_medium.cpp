// The path crosses the segment by delta tracking (medium/tracking.h). At the collision that
// scatters the path, a light and a direction are sampled. In three cases the path is not scattered,
// and its throughput is multiplied by the estimated transmittance instead: at the maximum depth, in
// media that do not scatter, and in local shading (the integrator `direct`, which leaves out
// indirect light).

#include "renderlib/integrate/through_grid_medium.h"

#include <optional>

#include "renderlib/integrate/mis.h"
#include "renderlib/integrate/russian_roulette.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/medium/phase.h"
#include "renderlib/medium/tracking.h"

namespace bandsaw {
namespace {

/// One segment of a ray in a medium that varies in space.
struct Segment {
  const PathContext& context;
  const Ray& ray;
  const MediumSegment& part;
  std::uint32_t number;  ///< index of the segment along its ray
  std::uint32_t depth;   ///< number of the path's next scattering

  const GridMedium& medium() const { return *part.varying; }
  double length() const { return part.end - part.begin; }
  /// Returns the point at a distance from the beginning of the segment.
  Vec3 at(double distance) const { return ray.origin + ray.direction * (part.begin + distance); }
  /// Returns random numbers of the segment; group_medium() lists their uses.
  Sample4 numbers(std::uint32_t which) const {
    return context.numbers(group_medium(depth, number, which));
  }
  NumberStream stream() const { return context.stream(group_medium(depth, number, /*which=*/3)); }
};

/// Returns the light-sampling estimate of the radiance that a collision at `position` scatters back
/// along the ray, for a throughput of 1.
Rgb sample_light(const Segment& segment, const Vec3& position) {
  const PathContext& context = segment.context;
  const Sample4 which = segment.numbers(2);  // the fourth number refines the selection of a light
  const std::optional<LightSample> light =
      context.scene.lights().sample({position, std::nullopt, segment.ray.time},
                                    which[0] + which[3] * 0x1p-32, which[1], which[2]);
  if (!light) {
    return {};
  }
  Ray shadow{.origin = position, .direction = light->direction, .time = segment.ray.time};
  if (!light->distant) {
    shadow.direction = light->target - position;
    shadow.t_max = 1;
  }
  const std::uint32_t group =
      group_shadow(segment.depth, ShadowUse::kMediumSegment, segment.number);
  const Rgb passing = transmittance(context.scene, shadow, context.stream(group), context.rays);
  if (is_black(passing)) {
    return {};
  }
  const double phase_pdf =
      phase(segment.medium().g(), dot(segment.ray.direction, light->direction));
  const bool weighted =
      context.options.technique == Technique::kBoth && !context.options.local && !light->delta;
  const double weight = weighted ? power_heuristic(light->pdf, phase_pdf) : 1;
  return light->radiance * passing * static_cast<float>(phase_pdf * weight / light->pdf);
}

/// Samples light at the collision, and scatters the path there into a sampled direction.
MediumEvent scatter(const Segment& segment, const Flight& flight, PathState& path) {
  const Vec3 position = segment.at(flight.distance);
  if (segment.context.samples_lights()) {
    path.radiance += flight.throughput * sample_light(segment, position);
  }
  const Sample4 at = segment.context.numbers(group_bsdf(segment.depth));
  const Vec3& before = segment.ray.direction;
  const Vec3 direction = sample_phase(segment.medium().g(), before, at[0], at[1]);
  path.throughput = flight.throughput;
  path.previous = {.receiver = {position, std::nullopt, segment.ray.time},
                   .pdf = phase(segment.medium().g(), dot(before, direction)),
                   .delta = false};
  const double time = segment.ray.time;
  path.ray = {.origin = position, .direction = direction, .time = time};
  return survives_roulette(segment.context, segment.depth, at[3], path) ? MediumEvent::kScattered
                                                                        : MediumEvent::kEnded;
}

/// Lets the medium scatter the path or lets it pass, as delta tracking decides.
MediumEvent fly_through(const Segment& segment, const GridRay& ray, PathState& path) {
  const Sample4 at = segment.numbers(0);
  NumberStream numbers = segment.stream();
  const Flight flight = fly(segment.medium(), ray, segment.length(), path.throughput,
                            {.choice = at[0], .distance = at[1]}, numbers);
  path.radiance += flight.emitted;
  if (flight.scattered) {
    return scatter(segment, flight, path);
  }
  path.throughput = flight.throughput;
  return is_black(path.throughput) ? MediumEvent::kEnded : MediumEvent::kPassed;
}

/// Lets the path pass the segment without scattering. If `lit` (local shading), adds the light that
/// the medium scatters once.
MediumEvent pass_through(const Segment& segment, const GridRay& ray, bool lit, PathState& path) {
  NumberStream numbers = segment.stream();
  if (!lit && !segment.medium().emits()) {
    path.throughput *= estimate_transmittance(segment.medium(), ray, segment.length(), numbers);
  } else {
    const Passage passage = pass(segment.medium(), ray, segment.length(), path.throughput, numbers);
    path.radiance += passage.emitted;
    path.throughput = passage.throughput;
    if (lit && !is_black(passage.scattered.weight)) {
      Rgb light = segment.context.scene.local_shading().ambient;
      if (segment.context.samples_lights()) {
        light += sample_light(segment, segment.at(passage.scattered.distance));
      }
      path.radiance += passage.scattered.weight * light;
    }
  }
  return is_black(path.throughput) ? MediumEvent::kEnded : MediumEvent::kPassed;
}

}  // namespace

MediumEvent through_grid_medium(const PathContext& context, const Ray& ray,
                                const MediumSegment& part, std::uint32_t number,
                                std::uint32_t depth, PathState& path) {
  const Segment segment{context, ray, part, number, depth};
  const GridRay in_space = in_medium_space(context.scene, ray, part);
  const PathOptions& options = context.options;
  const bool scatters = segment.medium().scatters();
  const bool is_last = context.is_at_end(path, depth);
  if (scatters && !is_last && !options.local) {
    return fly_through(segment, in_space, path);
  }
  const Rgb before = path.throughput;
  const MediumEvent event = pass_through(segment, in_space, scatters && !is_last, path);
  path.truncated = path.truncated || (is_last && scatters && path.throughput != before);
  return event;
}

}  // namespace bandsaw
