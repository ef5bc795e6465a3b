// Walks along the segments of the ray that lie in media (medium_traversal.h). In a homogeneous
// segment, a light is sampled from one point. The distance of this point along the ray is chosen
// with regard to up to four lights (pivots). Then the path is scattered in the segment or passes.

#include "renderlib/integrate/through_media.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "renderlib/integrate/light_distance_sampler.h"
#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/integrate/mis.h"
#include "renderlib/integrate/russian_roulette.h"
#include "renderlib/integrate/through_grid_medium.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/phase.h"

namespace bandsaw {
namespace {

/// One segment of a ray in a homogeneous medium.
struct Segment {
  const PathContext& context;
  std::uint32_t depth;   ///< number of the path's next scattering
  std::uint32_t number;  ///< index of the segment along its ray
  const Medium& medium;
  Vec3 origin;     ///< start of the segment
  Vec3 direction;  ///< unit
  double time;
  FreeFlight free_flight;
  double scatter_probability;  ///< probability that the path is scattered in the segment

  /// Returns random numbers of the segment; group_medium() lists their uses.
  Sample4 numbers(std::uint32_t which) const {
    return context.numbers(group_medium(depth, number, which));
  }
};

/// Builds the distance pdf for light sampling. Chooses up to four lights as pivots, in proportion
/// to their contribution along the whole segment. The random numbers that select the lights are
/// stratified, so that bright lights are not missed. The pivots MUST NOT depend on how the path
/// continues, nor on the light that is sampled afterwards.
LightDistanceSampler light_distance_sampler(const Segment& segment, double length) {
  LightDistanceSampler sampler(segment.free_flight, segment.medium);
  const Lights& lights = segment.context.scene.lights();
  if (!segment.context.samples_lights()) {
    return sampler;
  }
  const ReceiverSegment receiver{segment.origin, segment.direction, length,
                                 mean_extinction(segment.medium)};
  const Sample4 at = segment.numbers(1);
  const std::size_t pivots = std::min(lights.size(), LightDistanceSampler::kMaxPivots);
  for (std::size_t i = 0; i < pivots; ++i) {
    const double choice = (at[0] + static_cast<double>(i)) / static_cast<double>(pivots);
    const std::optional<LightPivot> pivot =
        lights.sample_pivot(receiver, segment.time, choice, at[1], at[2]);
    if (pivot && pivot->distant) {
      sampler.add_distant();
    } else if (pivot) {
      sampler.add(segment.origin, segment.direction, length, pivot->position);
    }
  }
  return sampler;
}

/// Returns the shadow ray from a point in a medium to a light sample.
Ray shadow_ray(const Segment& segment, const Vec3& position, const LightSample& light) {
  Ray ray{.origin = position, .direction = light.direction, .time = segment.time};
  if (!light.distant) {
    ray.direction = light.target - position;
    ray.t_max = 1;
  }
  return ray;
}

/// Samples a distance along the segment and a light from there. Returns the estimate of the
/// radiance that the segment scatters back along the ray. `at`: random numbers.
Rgb sample_light(const Segment& segment, const LightDistanceSampler& distances, const Sample4& at) {
  const PathContext& context = segment.context;
  const double distance = distances.sample(at[2], at[3]);
  const Vec3 position = segment.origin + segment.direction * distance;
  // The fourth number refines the selection among many lights.
  const Sample4 which = segment.numbers(2);
  const std::optional<LightSample> light = context.scene.lights().sample(
      {position, std::nullopt, segment.time}, which[0] + which[3] * 0x1p-32, which[1], which[2]);
  if (!light) {
    return {};
  }
  const double phase_pdf = phase(segment.medium.g, dot(segment.direction, light->direction));
  const std::uint32_t media =
      group_shadow(segment.depth, ShadowUse::kMediumSegment, segment.number);
  const Rgb passing = transmittance(context.scene, shadow_ray(segment, position, *light),
                                    context.stream(media), context.rays);
  if (is_black(passing)) {
    return {};
  }
  const double pdf = light->pdf * distances.pdf(distance);
  // The weight is needed if a scattered path could hit the light too. In local shading
  // (`options.local`, the integrator `direct`), media do not scatter paths.
  const bool weighted =
      context.options.technique == Technique::kBoth && !context.options.local && !light->delta;
  const double scattering_pdf =
      phase_pdf * segment.scatter_probability * segment.free_flight.pdf(distance);
  const double weight = weighted ? power_heuristic(pdf, scattering_pdf) : 1;
  return segment.free_flight.scattered(distance) * light->radiance * passing *
         static_cast<float>(phase_pdf * weight / pdf);
}

/// Scatters the path at `distance` into a sampled direction. `distance_pdf_ratio` is the pdf of
/// `distance` in light sampling over the pdf with which the path is scattered there.
MediumEvent scatter(const Segment& segment, double distance, double distance_pdf_ratio,
                    PathState& path) {
  const Sample4 at = segment.context.numbers(group_bsdf(segment.depth));
  path.throughput = segment.free_flight.after_scattering(distance);
  const Vec3 position = segment.origin + segment.direction * distance;
  const Vec3 direction = sample_phase(segment.medium.g, segment.direction, at[0], at[1]);
  const double pdf = phase(segment.medium.g, dot(segment.direction, direction));
  path.previous = {.receiver = {position, std::nullopt, segment.time},
                   .pdf = pdf,
                   .delta = false,
                   .distance_pdf_ratio = distance_pdf_ratio};
  path.ray.origin = position;
  path.ray.direction = direction;
  path.ray.from = kNoPrimitive;
  return survives_roulette(segment.context, segment.depth, at[3], path) ? MediumEvent::kScattered
                                                                        : MediumEvent::kEnded;
}

/// Sets the throughput of a path that passes the segment; a path without throughput ends.
MediumEvent pass(const Rgb& throughput, PathState& path) {
  path.throughput = throughput;
  return is_black(throughput) ? MediumEvent::kEnded : MediumEvent::kPassed;
}

/// Adds the light of the segment, and scatters the path in it or lets it pass.
MediumEvent through_segment(const Segment& segment, double length, PathState& path) {
  const PathOptions& options = segment.context.options;
  path.radiance += path.throughput * own_radiance(segment.medium, length);
  if (segment.scatter_probability == 0) {
    return pass(segment.free_flight.passing(), path);
  }
  const LightDistanceSampler distances = light_distance_sampler(segment, length);
  const Sample4 at = segment.numbers(0);
  if (segment.context.samples_lights()) {
    path.radiance += sample_light(segment, distances, at);
  }
  // Local shading has no indirect light. In its place, the medium scatters the scene's ambient
  // term, a constant radiance from all directions, and the path passes.
  if (options.local) {
    path.radiance +=
        segment.free_flight.all_scattered() * segment.context.scene.local_shading().ambient;
    return pass(segment.free_flight.passing(), path);
  }
  if (at[0] >= segment.scatter_probability) {
    return pass(segment.free_flight.after_passing(), path);
  }
  // The number that decided to scatter is stretched to [0, 1) and used again.
  const double distance = segment.free_flight.sample(at[0] / segment.scatter_probability, at[1]);
  const double scattering_pdf = segment.scatter_probability * segment.free_flight.pdf(distance);
  return scatter(segment, distance, distances.pdf(distance) / scattering_pdf, path);
}

/// Advances the path through the part `part` of `ray`, which is segment number `number`.
MediumEvent through_homogeneous_medium(const PathContext& context, const Ray& ray,
                                       const MediumSegment& part, std::uint32_t number,
                                       std::uint32_t depth, PathState& path) {
  const double length = part.end - part.begin;
  const FreeFlight free_flight(*part.medium, path.throughput, length);
  const bool may_scatter = !context.is_at_end(path, depth);
  path.truncated = path.truncated || (!may_scatter && free_flight.scatter_probability() > 0);
  const double scatter_probability = may_scatter ? free_flight.scatter_probability() : 0;
  const Vec3 origin = ray.origin + ray.direction * part.begin;
  const Segment segment{context,       depth,    number,      *part.medium,       origin,
                        ray.direction, ray.time, free_flight, scatter_probability};
  return through_segment(segment, length, path);
}

/// Sets `nesting.here` to the glasses that contain the end of `ray`, where a medium has scattered
/// the path. Before the scattering was known, intersect_visible() followed the ray as far as the
/// next surface. It updated `nesting.here` at each hidden boundary (a boundary of glass inside a
/// glass of higher priority), also at those beyond the end of `ray`.
void recompute_nesting(const PathContext& context, const Ray& ray, std::uint32_t depth,
                       NestedDielectrics& nesting) {
  nesting.here = nesting.before;
  intersect_visible(context.scene, ray, context.sampler, context.sample, depth, nesting,
                    context.rays);
}

}  // namespace

MediumEvent through_media(const PathContext& context, double length, std::uint32_t depth,
                          PathState& path) {
  const Ray ray = path.ray;
  MediumTraversal traversal(context.scene, ray, length, context.rays);
  for (std::uint32_t number = 0; const std::optional<MediumSegment> next = traversal.next();
       ++number) {
    const MediumEvent event =
        next->varying != nullptr
            ? through_grid_medium(context, ray, *next, number, depth, path)
            : through_homogeneous_medium(context, ray, *next, number, depth, path);
    if (event == MediumEvent::kScattered && path.nesting.skipped_hidden) {
      Ray passed = ray;
      passed.t_max = dot(path.ray.origin - ray.origin, ray.direction);
      recompute_nesting(context, passed, depth, path.nesting);
    }
    if (event != MediumEvent::kPassed) {
      return event;
    }
  }
  return MediumEvent::kPassed;
}

}  // namespace bandsaw
