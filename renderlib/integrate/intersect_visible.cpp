// Finds the hits of a ray one after the other, and skips hits at surfaces that are not there for
// this sample: holes by alpha, and boundaries of glass within a glass of higher priority. Where
// glasses with a priority (nested glasses) overlap, only the glass of the highest priority is
// present.

#include "renderlib/integrate/intersect_visible.h"

#include <algorithm>
#include <cmath>

#include "renderlib/material/mixture.h"
#include "renderlib/material/opacity.h"
#include "renderlib/material/shading_normal.h"

namespace bandsaw {
namespace {

SurfacePoint point_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  return surface_at(scene.geometry(), ray, hit, scene.features().uv);
}

/// Returns the next boundary of a nested glass that touches the boundary of `hit`, and advances
/// `hit` to it. Two boundaries touch if a ray that leaves the first one starts beyond both.
/// A boundary at a distance above `max_t` does not touch. Returns std::nullopt if the next surface
/// does not touch or is not a boundary of a nested glass.
std::optional<SurfacePoint> touching(const Scene& scene, const Ray& ray, double max_t, Hit& hit,
                                     std::uint64_t& rays) {
  ++rays;
  const Hit next = scene.accel().closest_after(ray, hit);
  if (!next || next.t > max_t) {
    return std::nullopt;
  }
  SurfacePoint point = point_at(scene, ray, next);
  if (nested_glass(scene.material(point.material)) == nullptr) {
    return std::nullopt;
  }
  hit = next;
  return point;
}

/// Treats the boundary `first` and all boundaries that touch it as one. Returns the surface of the
/// glass that is present on exactly one side of them; std::nullopt if the same glass is present on
/// both sides. `hit` becomes the last of the boundaries, and `nesting.beyond` the glasses beyond
/// it.
std::optional<SurfacePoint> nested_surface(const Scene& scene, const Ray& ray,
                                           const SurfacePoint& first, Hit& hit,
                                           NestedDielectrics& nesting, std::uint64_t& rays) {
  // The slope has a lower bound. Otherwise a grazing ray would count boundaries that are farther
  // along the ray and do not touch `first`.
  const double slope = std::max(0.01, std::abs(dot(ray.direction, first.geometric_normal)));
  const double max_t = hit.t + 0.5 * first.offset / slope;
  const MaterialId before = nesting.here.there();
  std::optional<SurfacePoint> entered;
  std::optional<SurfacePoint> left;
  std::optional<SurfacePoint> point = first;
  std::size_t boundaries = 0;
  nesting.beyond = nesting.here;
  for (; point; point = touching(scene, ray, max_t, hit, rays), ++boundaries) {
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

/// Returns the probability that the ray stops at a surface, in [0, 1]. A hidden lamp never stops a
/// camera ray. It stops every scattered ray (bounce > 0) that meets a side to which it emits.
double presence_for(const Scene& scene, const Ray& ray, const SurfacePoint& point,
                    std::uint32_t bounce) {
  const Material& material = scene.material(point.material);
  if (!is_hidden_lamp(material)) {
    return opacity(material, scene.textures(), point);
  }
  const bool emits = !std::get<Emissive>(material.kind).one_sided ||
                     dot(ray.direction, point.geometric_normal) < 0;
  return bounce > 0 && emits ? 1 : 0;
}

}  // namespace

void add_directions(const Scene& scene, SurfacePoint& point) {
  const Material& material = scene.material(point.material);
  const UvSets sets = uv_sets_of(material, scene.textures());
  for (const bool second : {false, true}) {
    if (!(second ? sets.second : sets.first)) {
      continue;
    }
    if (material.relief.height) {
      add_uv_derivatives(scene.geometry(), second, point);
    } else {
      add_uv_directions(scene.geometry(), second, point);
    }
  }
}

std::optional<SurfacePoint> intersect_visible(const Scene& scene, const Ray& ray,
                                              const PixelSampler& sampler, std::uint64_t sample,
                                              std::uint32_t bounce, NestedDielectrics& nesting,
                                              std::uint64_t& rays) {
  ++rays;
  nesting.skipped_hidden = false;
  Hit hit = scene.accel().closest(ray);
  for (std::uint32_t passed = 0; hit; ++passed) {
    SurfacePoint point = point_at(scene, ray, hit);
    if (scene.features().mixtures) {
      // A mixture of materials is one of its parts, chosen at random for this sample.
      const double number = sampler.group(sample, group_alpha(bounce, passed))[1];
      point.material = part_at(scene.materials(), scene.textures(), point.material, point, number);
    }
    const double presence = scene.features().alpha ? presence_for(scene, ray, point, bounce) : 1;
    const bool is_present =
        presence >= 1 ||
        (presence > 0 && sampler.group(sample, group_alpha(bounce, passed))[0] < presence);
    if (is_present && nested_glass(scene.material(point.material)) == nullptr) {
      add_directions(scene, point);
      return point;
    }
    if (is_present) {
      if (auto surface = nested_surface(scene, ray, point, hit, nesting, rays)) {
        add_directions(scene, *surface);
        return surface;
      }
      if (!nesting.skipped_hidden) {
        nesting.skipped_hidden = true;
        nesting.before = nesting.here;
      }
      nesting.here = nesting.beyond;
    }
    ++rays;
    hit = scene.accel().closest_after(ray, hit);
  }
  return std::nullopt;
}

}  // namespace bandsaw
