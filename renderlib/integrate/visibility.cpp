// Visibility is one any-hit query. If the scene has partly transparent surfaces, all hits along the
// ray are found in order instead, and their transparencies are multiplied.

#include "renderlib/integrate/visibility.h"

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/medium_traversal.h"
#include "renderlib/material/opacity.h"

namespace bandsaw {

float visibility(const Scene& scene, const Ray& ray, std::uint64_t& rays) {
  ++rays;
  if (!scene.features().alpha) {
    return scene.accel().occluded(ray) ? 0.0f : 1.0f;
  }
  double share = 1;
  for (Hit hit = scene.accel().closest(ray); hit && share > 0;
       hit = scene.accel().closest_after(ray, hit)) {
    const SurfacePoint point = surface_at(scene.geometry(), ray, hit);
    share *= 1 - opacity(scene.materials(), point.material, scene.textures(), point);
    rays += share > 0 ? 1 : 0;
  }
  return static_cast<float>(share);
}

Rgb transmittance(const Scene& scene, const Ray& ray, NumberStream numbers, std::uint64_t& rays) {
  const float share = visibility(scene, ray, rays);
  if (share == 0 || !scene.features().media) {
    return gray(share);
  }
  return media_transmittance(scene, ray, numbers, rays) * share;
}

}  // namespace bandsaw
