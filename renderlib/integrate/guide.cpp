// Follows a path from the camera through mirrors, smooth glass and nearly smooth metal to the first
// surface of another kind. Returns the albedo of that surface, or its shape (two coordinates of the
// normal, and the length of the path). Pictures of these values are the guides of the denoiser:
// they have hardly any noise, and the denoiser finds edges by them.
//
// guide_sample() takes more rays where their values differ. A wrong share of two surfaces in a
// pixel at their common edge is an error that the denoiser cannot remove.

#include "renderlib/integrate/guide.h"

#include <algorithm>
#include <limits>
#include <variant>

#include "renderlib/integrate/path_state.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/light/background.h"
#include "renderlib/material/albedo.h"
#include "renderlib/material/bsdf.h"
#include "renderlib/material/shading_normal.h"

namespace bandsaw {
namespace {

/// Maps each channel v of a radiance to v / (1 + v), at most 1. Huge values map to 1, because
/// infinity / infinity would not be a number.
Rgb compressed(const Rgb& light) {
  const auto channel = [](float v) { return v < 1e30f ? v / (1 + v) : 1.0f; };
  return {channel(light.r), channel(light.g), channel(light.b)};
}

/// Returns the components n of the normal along the camera's directions to the right and upwards,
/// each as (n + 1) / 2.
Vec2 seen_from_camera(const Camera& camera, const Vec3& normal) {
  const View view = view_of(camera);
  const Vec3 right = normalize(cross(view.look_at - view.position, view.up));
  const Vec3 up = normalize(cross(right, view.look_at - view.position));
  return {(dot(normal, right) + 1) / 2, (dot(normal, up) + 1) / 2};
}

/// Returns the shape of the surface: the two coordinates of its normal that seen_from_camera()
/// returns, and `distance`, which is the length of the path up to the surface.
Rgb shape(const Scene& scene, const SurfacePoint& point, const Vec3& direction, double distance) {
  Vec3 normal = bent_normal(scene.material(point.material).relief, scene.textures(), point);
  if (dot(point.geometric_normal, direction) > 0) {
    normal = -normal;
  }
  const Vec2 seen = seen_from_camera(scene.camera(), normal);
  return {static_cast<float>(std::max(0.0, seen.x)), static_cast<float>(std::max(0.0, seen.y)),
          static_cast<float>(distance)};
}

/// Returns true for a smooth boundary of glass and for a pane.
bool is_smooth_glass(const Bsdf& bsdf) {
  return std::holds_alternative<DielectricBsdf>(bsdf) ||
         std::holds_alternative<ThinDielectricBsdf>(bsdf);
}

/// Returns true if the guide shows what is seen in the surface, and not the surface itself.
bool is_followed(const Bsdf& bsdf) {
  if (const auto* metal = std::get_if<FuzzyMetalBsdf>(&bsdf)) {
    return metal->fuzz <= kMaxGuideFuzz;
  }
  return std::holds_alternative<MirrorBsdf>(bsdf) || is_smooth_glass(bsdf);
}

/// Samples the direction in which the guide follows the path. Returns std::nullopt if the guide
/// shows the surface at `point` itself.
std::optional<BsdfSample> next_direction(const PathContext& context, const SurfacePoint& point,
                                         std::uint32_t depth, PathState& path) {
  // Most surfaces are diffuse. No BSDF is made for them, because that takes a tenth of the time.
  if (depth >= kMaxGuideBounces ||
      std::holds_alternative<Diffuse>(context.scene.material(point.material).kind)) {
    return std::nullopt;
  }
  const std::optional<Bsdf> bsdf = make_bsdf(context, point, depth, path);
  if (!bsdf || !is_followed(*bsdf)) {
    return std::nullopt;
  }
  const Sample4 numbers = context.numbers(group_bsdf(depth));
  // All samples follow the brighter of reflection and refraction by glass, because the denoiser
  // would take a random choice for detail.
  const double lobe = is_smooth_glass(*bsdf) ? 0.5 : numbers[2];
  return bandsaw::sample(*bsdf, numbers[0], numbers[1], lobe);
}

/// The range of the values of a pixel's rays.
class GuideRange {
 public:
  void add(const Rgb& value) {
    least_ = {std::min(least_.r, value.r), std::min(least_.g, value.g),
              std::min(least_.b, value.b)};
    most_ = {std::max(most_.r, value.r), std::max(most_.g, value.g), std::max(most_.b, value.b)};
  }
  /// Returns the largest difference of two values: of a channel of the albedo, or of a coordinate
  /// of the normal or the distance. That of the distance is relative to the larger one.
  float difference(Integrator integrator) const {
    const float unit = integrator == kGuideShape ? std::max(most_.b, 1e-30f) : 1.0f;
    return std::max({most_.r - least_.r, most_.g - least_.g, (most_.b - least_.b) / unit});
  }

 private:
  static constexpr float kMost = std::numeric_limits<float>::max();
  Rgb least_{kMost, kMost, kMost};
  Rgb most_{};
};

/// Values that differ by at most this are alike; see GuideRange::difference().
constexpr float kAlike = 0.06f;
/// If values differ by more than this, a pixel takes all rays.
constexpr float kSharp = 0.3f;

}  // namespace

Rgb guide_value(const Scene& scene, Integrator integrator, const Ray& ray,
                const PixelSampler& sampler, std::uint64_t number, std::uint64_t& rays) {
  const PathOptions options{.max_depth = kMaxGuideBounces + 1};
  const PathContext context{scene, sampler, number, options, rays};
  PathState path(ray);
  const bool albedo = integrator == kGuideAlbedo;
  double distance = 0;
  for (std::uint32_t depth = 0;; ++depth) {
    const std::optional<SurfacePoint> hit = next_surface(context, depth, path);
    if (!hit) {
      return albedo ? compressed(path.throughput *
                                 radiance(scene.background(), scene.textures(), path.ray.direction))
                    : Rgb{0.5f, 0.5f, 0};
    }
    distance += length(hit->position - path.ray.origin);
    const std::optional<BsdfSample> next = next_direction(context, *hit, depth, path);
    if (!next) {
      return albedo ? path.throughput *
                          albedo_at(scene.material(hit->material), scene.textures(), *hit)
                    : shape(scene, *hit, path.ray.direction, distance);
    }
    path.throughput *= next->weight * static_cast<float>(1 / next->compression);
    // If the path passes the boundary of a nested glass, the glasses around it change.
    if (dot(next->wi, hit->geometric_normal) * dot(path.ray.direction, hit->geometric_normal) > 0 &&
        nested_glass(scene.material(hit->material)) != nullptr) {
      path.nesting.here = path.nesting.beyond;
    }
    path.previous.delta = true;
    path.ray = spawn_ray(*hit, next->wi);
  }
}

Rgb guide_sample(const Scene& scene, Integrator integrator, const PixelSampler& sampler,
                 std::uint64_t sample, GuideCamera camera, std::uint64_t& rays) {
  GuideRange range;
  const auto value = [&](std::uint64_t ray, double spread) {
    const std::uint64_t number = sample * kMaxGuideRays + ray;
    const Rgb found = guide_value(scene, integrator, camera(number, spread), sampler, number, rays);
    range.add(found);
    return found;
  };
  Rgb sum{};
  for (std::uint64_t ray = 0; ray < kProbeGuideRays; ++ray) {
    sum += value(ray, kProbeSpread);
  }
  if (range.difference(integrator) <= kAlike) {
    return sum * (1.0f / kProbeGuideRays);
  }
  sum = {};
  std::uint64_t taken = 0;
  for (; taken < kSomeGuideRays; ++taken) {
    sum += value(taken, 1);
  }
  if (range.difference(integrator) > kSharp) {
    for (; taken < kMaxGuideRays; ++taken) {
      sum += value(taken, 1);
    }
  }
  return sum * (1.0f / static_cast<float>(taken));
}

}  // namespace bandsaw
