#include "renderlib/integrate/see_through.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/opacity.h"
#include "renderlib/material/shading_normal.h"

namespace bandsaw {
namespace {

SurfacePoint point_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  SurfacePoint point = surface_at(scene.geometry(), ray, hit, scene.features().uv);
  if (const auto* principled = std::get_if<Principled>(&scene.material(point.material))) {
    const NormalUvSets sets = normal_uv_sets(*principled, scene.textures());
    if (sets.first) {
      add_uv_directions(scene.geometry(), false, point);
    }
    if (sets.second) {
      add_uv_directions(scene.geometry(), true, point);
    }
  }
  return point;
}

/// The next boundary of a nested glass that touches the one of `hit`: so near that a ray which
/// leaves that one starts beyond both.
std::optional<SurfacePoint> touching(const Scene& scene, const Ray& ray, double most_t, Hit& hit,
                                     std::uint64_t& rays) {
  ++rays;
  const Hit next = scene.accel().closest_after(ray, hit);
  if (!next || next.t > most_t) {
    return std::nullopt;
  }
  SurfacePoint point = point_at(scene, ray, next);
  if (nested_glass(scene.material(point.material)) == nullptr) {
    return std::nullopt;
  }
  hit = next;
  return point;
}

/// What is seen of the boundaries that touch `first`; nothing: the same glass is there on both
/// sides. `hit` becomes the last of them.
std::optional<SurfacePoint> nested_surface(const Scene& scene, const Ray& ray,
                                           const SurfacePoint& first, Hit& hit, Nesting& nesting,
                                           std::uint64_t& rays) {
  // Not flatter than that: along the surface others are met that do not touch it.
  const double slope = std::max(0.01, std::abs(dot(ray.direction, first.geometric_normal)));
  const double most_t = hit.t + 0.5 * first.offset / slope;
  const MaterialId before = nesting.here.there();
  std::optional<SurfacePoint> entered;
  std::optional<SurfacePoint> left;
  std::optional<SurfacePoint> point = first;
  std::size_t boundaries = 0;
  nesting.beyond = nesting.here;
  for (; point; point = touching(scene, ray, most_t, hit, rays), ++boundaries) {
    const Dielectric& glass = *nested_glass(scene.material(point->material));
    const bool inwards = dot(ray.direction, point->geometric_normal) < 0;
    nesting.beyond.pass(point->material, glass, inwards);
    if (inwards && nesting.beyond.there() == point->material) {
      entered = point;
    } else if (!inwards && point->material == before) {
      left = point;
    }
  }
  const MaterialId after = nesting.beyond.there();
  if (boundaries == 1) {
    const Dielectric& glass = *nested_glass(scene.material(first.material));
    const bool inwards = dot(ray.direction, first.geometric_normal) < 0;
    return nesting.here.hides(first.material, glass, inwards) ? std::nullopt : std::optional(first);
  }
  return after == before ? std::nullopt : entered && entered->material == after ? entered : left;
}

}  // namespace

std::optional<SurfacePoint> first_surface(const Scene& scene, const Ray& ray,
                                          const PixelSampler& sampler, std::uint64_t sample,
                                          std::uint32_t bounce, Nesting& nesting,
                                          std::uint64_t& rays) {
  ++rays;
  nesting.passed_unseen = false;
  Hit hit = scene.accel().closest(ray);
  for (std::uint32_t passed = 0; hit; ++passed) {
    const SurfacePoint point = point_at(scene, ray, hit);
    const double there = scene.features().alpha
                             ? opacity(scene.material(point.material), scene.textures(), point)
                             : 1;
    const bool is_there =
        there >= 1 || (there > 0 && sampler.group(sample, group_alpha(bounce, passed))[0] < there);
    if (is_there && nested_glass(scene.material(point.material)) == nullptr) {
      return point;
    }
    if (is_there) {
      if (auto seen = nested_surface(scene, ray, point, hit, nesting, rays)) {
        return seen;
      }
      if (!nesting.passed_unseen) {
        nesting.passed_unseen = true;
        nesting.before = nesting.here;
      }
      nesting.here = nesting.beyond;
    }
    ++rays;
    hit = scene.accel().closest_after(ray, hit);
  }
  return std::nullopt;
}

float unoccluded(const Scene& scene, const Ray& ray, std::uint64_t& rays) {
  ++rays;
  if (!scene.features().alpha) {
    return scene.accel().occluded(ray) ? 0.0f : 1.0f;
  }
  double share = 1;
  for (Hit hit = scene.accel().closest(ray); hit && share > 0;
       hit = scene.accel().closest_after(ray, hit)) {
    const SurfacePoint point = surface_at(scene.geometry(), ray, hit);
    share *= 1 - opacity(scene.material(point.material), scene.textures(), point);
    ++rays;
  }
  return static_cast<float>(share);
}

}  // namespace bandsaw
