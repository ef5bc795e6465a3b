#include "renderlib/integrate/path.h"

#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/integrate/path_steps.h"
#include "renderlib/integrate/through_lens.h"
#include "renderlib/integrate/through_media.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {
namespace {

/// Goes on from a surface, as scattering `depth`, in all directions that the path has before it.
void follow_branches(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
                     std::uint32_t depth, PathState& path) {
  Rgb sum;
  for (std::uint32_t i = 0; i < context.branches; ++i) {
    const PathContext of_branch = context.branch(i);
    PathState branch = path;
    branch.radiance = {};
    if (scatter(of_branch, point, bsdf, depth, branch)) {
      follow(of_branch, depth + 1, branch);
    }
    sum += branch.radiance;
    path.truncated |= branch.truncated;
  }
  path.radiance += sum * (1 / static_cast<float>(context.branches));
}

}  // namespace

std::uint32_t branches_for(const Scene& scene) {
  if (!scene.lights().empty()) {
    return 1;
  }
  return scene.geometry().meshes.empty() ? 2 : 4;
}

void follow(const PathContext& context, std::uint32_t depth, PathState& path) {
  for (;; ++depth) {
    const std::optional<SurfacePoint> seen = next_surface(context, depth, path);
    if (seen) {
      see_surface(context, *seen, path);
    }
    if (context.scene.features().media) {
      const double way = seen ? distance_along(path.ray, *seen) : kInfinity;
      const Passage passage = through_media(context, way, depth, path);
      if (passage == Passage::kEnded) {
        return;
      }
      if (passage == Passage::kScattered) {
        continue;
      }
    }
    if (!seen) {
      leave_scene(context, path);
      return;
    }
    const std::optional<Bsdf> bsdf = arrive(context, *seen, depth, path);
    if (!bsdf) {
      return;
    }
    if (context.branches > 1 && has_density(*bsdf)) {
      follow_branches(context, *seen, *bsdf, depth, path);
      return;
    }
    if (!scatter(context, *seen, *bsdf, depth, path)) {
      return;
    }
  }
}

Rgb path_radiance(const Scene& scene, const CameraRay& camera_ray, const PixelSampler& sampler,
                  std::uint64_t sample, const PathOptions& options, PathCounts& counts) {
  const PathContext context{scene, sampler, sample, options, counts.rays, options.branches};
  PathState path(camera_ray.ray);
  if (camera_ray.lens) {
    ask_through_lens(context, *camera_ray.lens, path);
  }
  follow(context, 0, path);
  counts.truncated += path.truncated ? 1 : 0;
  return path.radiance;
}

}  // namespace bandsaw
