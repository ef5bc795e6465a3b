#pragma once

// The steps of a path. path.cpp defines them; path.cpp, path_reuse.cpp and the training of path
// guiding build their paths from them.

#include <cstdint>
#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/guided_bsdf.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {

/// Returns the first visible surface along the path's ray; std::nullopt if the ray leaves the
/// scene. In all functions of this file, `depth` is the number of the scattering that may happen at
/// the surface, from 0.
inline std::optional<SurfacePoint> next_surface(const PathContext& context, std::uint32_t depth,
                                                PathState& path) {
  std::optional<SurfacePoint> hit = intersect_visible(
      context.scene, path.ray, context.sampler, context.sample, depth, path.nesting, context.rays);
  // The path skips hidden boundaries of nested glass, but shadow rays stop there. So light sampling
  // does not cover a hit beyond a hidden boundary.
  path.previous.delta = path.previous.delta || path.nesting.skipped_hidden;
  return hit;
}

/// Adds the emission of the surface at `point`, which the path's ray hits. The emission is
/// multiplied by its MIS weight and by the transmittance of all media on the ray.
///
/// trace_path() calls this function before a random number decides whether a medium on the ray
/// scatters the path. So the emission of a lamp is added even if the path is then scattered in
/// front of the lamp. The calls have this order because a lamp is usually brighter than the medium
/// in front of it, and the light of the lamp then does not depend on the random number. No extra
/// path is traced to compute the transmittance.
void add_emission(const PathContext& context, const SurfacePoint& point, std::uint32_t depth,
                  PathState& path);

/// Adds the background radiance with its MIS weight when the path leaves the scene.
void add_background(const PathContext& context, PathState& path);

/// Returns the BSDF of the surface at `point`, where scattering number `depth` may happen. Returns
/// std::nullopt if the surface does not scatter. Marks the path as truncated and returns
/// std::nullopt if `max_depth` is reached.
std::optional<Bsdf> make_bsdf(const PathContext& context, const SurfacePoint& point,
                              std::uint32_t depth, PathState& path);

/// Adds the light-sampling estimate at the surface, samples a direction, applies Russian roulette,
/// and continues the path in the sampled direction. Returns false if the path ends. `bsdf` is the
/// result of `make_bsdf()`, and `cones` that of `cones_at()`: cones of directions from which path
/// guiding expects light, or none.
bool scatter(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
             const GuidingCones& cones, std::uint32_t depth, PathState& path);

/// Runs `add_emission()`, `make_bsdf()` and `scatter()`. Returns false if the path ends.
inline bool scatter_at(const PathContext& context, const SurfacePoint& point, std::uint32_t depth,
                       PathState& path) {
  add_emission(context, point, depth, path);
  const std::optional<Bsdf> bsdf = make_bsdf(context, point, depth, path);
  return bsdf && scatter(context, point, *bsdf,
                         cones_at(context, point, *bsdf, -path.ray.direction), depth, path);
}

/// Traces the path along its ray, from scattering `depth` until it ends.
void trace_path(const PathContext& context, std::uint32_t depth, PathState& path);

}  // namespace bandsaw
