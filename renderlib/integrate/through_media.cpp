#include "renderlib/integrate/through_media.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/integrate/asked_distance.h"
#include "renderlib/integrate/medium_walk.h"
#include "renderlib/integrate/see_through.h"
#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/phase.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// One segment of medium before scattering number `depth`.
struct Step {
  const PathContext& context;
  std::uint32_t depth;
  std::uint32_t number;  ///< index of the segment along its ray
  const Medium& medium;
  Vec3 origin;  ///< start of the segment
  Vec3 way;     ///< direction; unit
  double time;
  Flight flight;
  double chance;  ///< probability that the path is scattered in the segment

  Sample4 numbers(std::uint32_t which) const {
    return context.numbers(group_medium(depth, number, which));
  }
};

/// Builds the distance pdf for light sampling: chooses up to four lights as pivots, by their
/// contribution along the whole segment and stratified over the light-selection number, so that
/// bright lights are not missed. The pivots MUST NOT depend on how the path continues, nor on the
/// light that is sampled afterwards.
AskedDistance asked_distance(const Step& step, double length) {
  AskedDistance asked(step.flight, step.medium);
  const Lights& lights = step.context.scene.lights();
  if (!step.context.asks_lights()) {
    return asked;
  }
  const LitStretch stretch{step.origin, step.way, length, mean_extinction(step.medium)};
  const Sample4 at = step.numbers(1);
  const std::size_t pivots = std::min(lights.size(), AskedDistance::kMaxPivots);
  for (std::size_t i = 0; i < pivots; ++i) {
    const double choice = (at[0] + static_cast<double>(i)) / static_cast<double>(pivots);
    const std::optional<LightPlace> place = lights.place(stretch, step.time, choice, at[1], at[2]);
    if (place && place->distant) {
      asked.add_distant();
    } else if (place) {
      asked.add(step.origin, step.way, length, place->position);
    }
  }
  return asked;
}

/// Returns the shadow ray from a point in a medium to a light sample.
Ray toward(const Step& step, const Vec3& position, const LightSample& light) {
  Ray ray{.origin = position, .direction = light.direction, .time = step.time};
  if (!light.distant) {
    ray.direction = light.target - position;
    ray.t_max = 1;
  }
  return ray;
}

/// Returns the light-sampling estimate of the radiance that one point of the segment scatters back
/// along it.
Rgb asked_light(const Step& step, const AskedDistance& asked, const Sample4& at) {
  const PathContext& context = step.context;
  const double distance = asked.sample(at[2], at[3]);
  const Vec3 position = step.origin + step.way * distance;
  const Sample4 which = step.numbers(2);
  const std::optional<LightSample> light = context.scene.lights().sample(
      {position, std::nullopt, step.time}, which[0] + which[3] * 0x1p-32, which[1], which[2]);
  if (!light) {
    return {};
  }
  const double turned = phase(step.medium.g, dot(step.way, light->direction));
  const Rgb passing = passing_light(context.scene, toward(step, position, *light), context.rays);
  if (is_black(passing)) {
    return {};
  }
  const double pdf = light->pdf * asked.pdf(distance);
  const bool both =
      context.options.technique == Technique::kBoth && !context.options.local && !light->delta;
  const double other = turned * step.chance * step.flight.pdf(distance);
  const double weight = both ? power_heuristic(pdf, other) : 1;
  return step.flight.scattered(distance) * light->radiance * passing *
         static_cast<float>(turned * weight / pdf);
}

/// Scatters the path at `distance` into a sampled direction. `asked` is Departure::asked.
Passage scatter(const Step& step, double distance, double asked, PathState& path) {
  const Sample4 at = step.context.numbers(group_bsdf(step.depth));
  path.throughput = step.flight.after_scattering(distance);
  const Vec3 position = step.origin + step.way * distance;
  const Vec3 direction = sample_phase(step.medium.g, step.way, at[0], at[1]);
  const double pdf = phase(step.medium.g, dot(step.way, direction));
  path.departure = {
      .from = {position, std::nullopt, step.time}, .pdf = pdf, .delta = false, .asked = asked};
  path.ray.origin = position;
  path.ray.direction = direction;
  path.ray.from = kNoPrimitive;
  return survives(step.context, step.depth, at[3], path) ? Passage::kScattered : Passage::kEnded;
}

Passage pass(const Rgb& throughput, PathState& path) {
  path.throughput = throughput;
  return is_black(throughput) ? Passage::kEnded : Passage::kThrough;
}

Passage through(const Step& step, double length, PathState& path) {
  const PathOptions& options = step.context.options;
  path.radiance += path.throughput * own_radiance(step.medium, length);
  if (step.chance == 0) {
    return pass(step.flight.passing(), path);
  }
  const AskedDistance asked = asked_distance(step, length);
  const Sample4 at = step.numbers(0);
  if (step.context.asks_lights()) {
    path.radiance += asked_light(step, asked, at);
  }
  if (options.local) {
    path.radiance += step.flight.all_scattered() * step.context.scene.local_shading().ambient;
    return pass(step.flight.passing(), path);
  }
  if (at[0] >= step.chance) {
    return pass(step.flight.after_passing(), path);
  }
  const double distance = step.flight.sample(at[0] / step.chance, at[1]);
  const double followed = step.chance * step.flight.pdf(distance);
  return scatter(step, distance, asked.pdf(distance) / followed, path);
}

/// Recomputes the nesting of a path that scattered at the end of `ray`, before the surface that
/// `first_surface()` found: only the boundaries of nested glass up to there are passed.
void pass_again(const PathContext& context, const Ray& ray, std::uint32_t depth, Nesting& nesting) {
  nesting.here = nesting.before;
  first_surface(context.scene, ray, context.sampler, context.sample, depth, nesting, context.rays);
}

}  // namespace

Passage through_media(const PathContext& context, double length, std::uint32_t depth,
                      PathState& path) {
  const Ray ray = path.ray;
  MediumWalk walk(context.scene, ray, length, context.rays);
  for (std::uint32_t number = 0; const std::optional<Stretch> stretch = walk.next(); ++number) {
    const double part = stretch->end - stretch->begin;
    const Flight flight(*stretch->medium, path.throughput, part);
    const bool may_scatter = depth < context.options.max_depth;
    path.truncated = path.truncated || (!may_scatter && flight.chance() > 0);
    const double chance = may_scatter ? flight.chance() : 0;
    const Vec3 origin = ray.origin + ray.direction * stretch->begin;
    const Step step{context,  depth,  number, *stretch->medium, origin, ray.direction,
                    ray.time, flight, chance};
    const Passage passage = through(step, part, path);
    if (passage == Passage::kScattered && path.nesting.passed_unseen) {
      Ray passed = ray;
      passed.t_max = dot(path.ray.origin - ray.origin, ray.direction);
      pass_again(context, passed, depth, path.nesting);
    }
    if (passage != Passage::kThrough) {
      return passage;
    }
  }
  return Passage::kThrough;
}

Rgb passing_light(const Scene& scene, const Ray& ray, std::uint64_t& rays) {
  const float share = unoccluded(scene, ray, rays);
  if (share == 0 || !scene.features().media) {
    return gray(share);
  }
  return media_transmittance(scene, ray, rays) * share;
}

}  // namespace bandsaw
