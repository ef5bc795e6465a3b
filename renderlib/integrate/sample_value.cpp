// Selects the function of the integrator: path tracing, or a picture of the first surface
// (normal, depth, albedo or ambient occlusion).

#include "renderlib/integrate/sample_value.h"

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/intersect_visible.h"
#include "renderlib/integrate/visibility.h"
#include "renderlib/material/albedo.h"
#include "renderlib/material/look_up.h"
#include "renderlib/material/shading_normal.h"
#include "renderlib/sampling/basis.h"
#include "renderlib/sampling/warp.h"

namespace bandsaw {
namespace {

/// Maps a direction to a colour, each channel in [0, 1].
Rgb as_color(const Vec3& n) {
  const auto channel = [](double v) { return static_cast<float>((v + 1) / 2); };
  return {channel(n.x), channel(n.y), channel(n.z)};
}

/// Samples one direction on the viewer's side with a pdf proportional to the cosine. Returns the
/// visibility, in [0, 1], along this direction up to the occlusion distance. Adds the number of
/// rays traced to `rays`.
float openness(const Scene& scene, const SurfacePoint& point, const Vec3& wo, double u, double v,
               std::uint64_t& rays) {
  const Vec3 normal = facing_normal(point, wo);
  const Vec3 direction = orthonormal_basis(normal).to_world(sample_cosine_hemisphere(u, v));
  if (!(dot(direction, normal) > 0)) {
    return 0;
  }
  const double distance = scene.local_shading().occlusion_distance;
  return visibility(scene, spawn_ray(point, normalize(direction), distance), rays);
}

/// Returns the value of an integrator that shows only the first surface. Where the ray leaves the
/// scene, the value is white for ambient occlusion, otherwise black.
Rgb value_at(const Scene& scene, Integrator integrator, const Ray& ray, const PixelSampler& sampler,
             std::uint64_t sample, std::uint64_t& rays) {
  NestedDielectrics nesting;
  const auto hit = intersect_visible(scene, ray, sampler, sample, 0, nesting, rays);
  if (!hit) {
    return gray(integrator == Integrator::kAmbientOcclusion ? 1.0f : 0.0f);
  }
  const SurfacePoint& point = *hit;
  if (integrator == Integrator::kDepth) {
    return gray(static_cast<float>(length(point.position - ray.origin)));
  }
  if (integrator == Integrator::kNormals) {
    return as_color(bent_normal(scene.material(point.material).relief, scene.textures(), point));
  }
  if (integrator == Integrator::kAlbedo) {
    return albedo_at(scene.material(point.material), scene.textures(), point);
  }
  const Sample4 numbers = sampler.group(sample, group_bsdf(0));
  return gray(openness(scene, point, -ray.direction, numbers[0], numbers[1], rays));
}

}  // namespace

Rgb sample_value(const Scene& scene, Integrator integrator, const CameraRay& camera_ray,
                 const PixelSampler& sampler, std::uint64_t sample, const PathOptions& options,
                 PathCounts& counts) {
  if (computes_radiance(integrator)) {
    return path_radiance(scene, camera_ray, sampler, sample, options, counts);
  }
  return value_at(scene, integrator, camera_ray.ray, sampler, sample, counts.rays);
}

}  // namespace bandsaw
