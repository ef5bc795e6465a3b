#include "renderlib/integrate/path_reuse.h"

#include <array>
#include <cmath>
#include <optional>

#include "renderlib/base/check.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/through_lens.h"

namespace bandsaw {
namespace {

/// What a pixel sees first, where it can scatter light of others; `to_viewer`: its geometric normal
/// on the side that is seen.
struct Taker {
  SurfacePoint point;
  Vec3 to_viewer;
  Bsdf bsdf;
};

/// What a path met second, the normal on the side that it came from, and what comes from there.
struct SharedVertex {
  SurfacePoint point;
  Vec3 to_finder;
  Rgb radiance;
};

Vec3 facing(const SurfacePoint& point, const Ray& ray) {
  return dot(point.geometric_normal, ray.direction) <= 0 ? point.geometric_normal
                                                         : -point.geometric_normal;
}

/// Follows a pixel's path, and leaves in it the radiance that is the pixel's alone; `found` is what
/// is shared, by the pixel as well.
void follow_own(const PathContext& context, PathState& path, std::optional<Taker>& taker,
                std::optional<SharedVertex>& found) {
  const Ray camera_ray = path.ray;
  const std::optional<SurfacePoint> first = next_surface(context, 0, path);
  if (!first) {
    leave_scene(context, path);
    return;
  }
  see_surface(context, *first, path);
  const std::optional<Bsdf> bsdf = arrive(context, *first, 0, path);
  if (!bsdf) {
    return;
  }
  if (has_density(*bsdf)) {
    taker = Taker{*first, facing(*first, camera_ray), *bsdf};
  }
  if (!scatter(context, *first, *bsdf, 0, path)) {
    return;
  }
  const std::optional<SurfacePoint> second = next_surface(context, 1, path);
  if (!second) {
    leave_scene(context, path);
    return;
  }
  const Rgb own = path.radiance;
  const bool shared = taker && !path.departure.delta &&
                      std::holds_alternative<Diffuse>(context.scene.material(second->material));
  if (shared) {
    found = SharedVertex{*second, facing(*second, path.ray), {}};
    path.radiance = {};
    path.throughput = gray(1);
  }
  if (scatter_at(context, *second, 1, path)) {
    follow(context, 2, path);
  }
  if (shared) {
    found->radiance = path.radiance;
    path.radiance = own;
  }
}

using Takers = std::array<std::optional<Taker>, kMaxReusePixels>;

/// What a taker scatters from there by solid angle, and the solid angle of an area there; no
/// density where it would not be found from the side that it was found from.
struct View {
  BsdfValue scattered;
  double per_area = 0;
};

View view_of(const Taker& taker, const SharedVertex& found) {
  const Vec3 way = found.point.position - taker.point.position;
  const double facing_way = -dot(way, found.to_finder);
  if (!(dot(way, taker.to_viewer) > 0) || !(facing_way > 0)) {
    return {};
  }
  const double distance2 = length_squared(way);
  const double distance = std::sqrt(distance2);
  return {evaluate(taker.bsdf, way / distance), facing_way / (distance2 * distance)};
}

/// Adds what pixel `finder` found to all that see it.
void deal_out(const Scene& scene, const Takers& takers, const SharedVertex& found,
              std::size_t finder, absl::Span<ReusePixel> pixels, std::uint64_t& rays) {
  std::array<View, kMaxReusePixels> views;
  double density = 0;  // Of all pixels, by area.
  for (std::size_t j = 0; j < pixels.size(); ++j) {
    if (!takers[j]) {
      continue;
    }
    const View view = view_of(*takers[j], found);
    if (j != finder && view.scattered.pdf > 0) {
      ++rays;
      if (scene.accel().occluded(spawn_ray_to(takers[j]->point, found.point))) {
        continue;
      }
    }
    views[j] = view;
    density += view.scattered.pdf * view.per_area;
  }
  for (std::size_t j = 0; density > 0 && j < pixels.size(); ++j) {
    pixels[j].radiance +=
        views[j].scattered.value * found.radiance * static_cast<float>(views[j].per_area / density);
  }
}

}  // namespace

void radiance_with_reuse(const Scene& scene, absl::Span<ReusePixel> pixels, std::uint64_t sample,
                         const PathOptions& options, PathCounts& counts) {
  BANDSAW_CHECK(pixels.size() <= kMaxReusePixels, "more pixels than may share");
  Takers takers;
  std::array<std::optional<SharedVertex>, kMaxReusePixels> found;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const PathContext context{scene, pixels[i].sampler, sample, options, counts.rays};
    PathState path(pixels[i].camera_ray.ray);
    if (pixels[i].camera_ray.lens) {
      ask_through_lens(context, *pixels[i].camera_ray.lens, path);
    }
    follow_own(context, path, takers[i], found[i]);
    pixels[i].radiance = path.radiance;
    counts.truncated += path.truncated ? 1 : 0;
  }
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (found[i] && !is_black(found[i]->radiance)) {
      deal_out(scene, takers, *found[i], i, pixels, counts.rays);
    }
  }
}

}  // namespace bandsaw
