#include "renderlib/integrate/see_through.h"

#include "renderlib/material/opacity.h"

namespace bandsaw {
namespace {

SurfacePoint point_at(const Scene& scene, const Ray& ray, const Hit& hit) {
  SurfacePoint point = surface_at(scene.geometry(), ray, hit, scene.needs().uv);
  const auto* principled = std::get_if<Principled>(&scene.material(point.material));
  if (principled != nullptr && (principled->normal || principled->coat_normal)) {
    add_uv_directions(scene.geometry(), point);
  }
  return point;
}

bool is_hidden(const Scene& scene, const Ray& ray, const SurfacePoint& point,
               Interiors& interiors) {
  const auto* glass = std::get_if<Dielectric>(&scene.material(point.material));
  if (glass == nullptr || glass->priority == 0 || !interiors.hides(point.material, *glass)) {
    return false;
  }
  interiors.pass(point.material, *glass, dot(ray.direction, point.geometric_normal) < 0);
  return true;
}

}  // namespace

std::optional<SurfacePoint> first_surface(const Scene& scene, const Ray& ray,
                                          const PixelSampler& sampler, std::uint64_t sample,
                                          std::uint32_t bounce, Interiors& interiors,
                                          std::uint64_t& rays) {
  ++rays;
  Hit hit = scene.accel().closest(ray);
  for (std::uint32_t passed = 0; hit; ++passed) {
    const SurfacePoint point = point_at(scene, ray, hit);
    const double there =
        scene.needs().alpha ? opacity(scene.material(point.material), scene.textures(), point) : 1;
    const bool is_there =
        there >= 1 || (there > 0 && sampler.group(sample, group_alpha(bounce, passed))[0] < there);
    if (is_there && !is_hidden(scene, ray, point, interiors)) {
      return point;
    }
    ++rays;
    hit = scene.accel().closest_after(ray, hit);
  }
  return std::nullopt;
}

float unoccluded(const Scene& scene, const Ray& ray, std::uint64_t& rays) {
  ++rays;
  if (!scene.needs().alpha) {
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
