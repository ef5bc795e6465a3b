#pragma once

// The steps of a path, for those who put paths together: path.cpp and shared_paths.cpp.

#include <cstdint>
#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/integrate/path_state.h"
#include "renderlib/material/bsdf.h"

namespace bandsaw {

/// The first surface along the path's ray, on the way to scattering `depth`.
inline std::optional<SurfacePoint> next_surface(const PathContext& context, std::uint32_t depth,
                                                PathState& path) {
  std::optional<SurfacePoint> seen = first_surface(
      context.scene, path.ray, context.sampler, context.sample, depth, path.nesting, context.rays);
  // A boundary that a path passes unseen stops those who ask for light.
  path.departure.delta = path.departure.delta || path.nesting.passed_unseen;
  return seen;
}

/// Adds the own light of the surface that the path's ray meets, faded by all media before it. What
/// is added there is not left to whether the path passes them: a lamp is brighter than what is
/// scattered before it, and costs no ray.
void see_surface(const PathContext& context, const SurfacePoint& point, PathState& path);

/// The path meets a surface as scattering `depth`. How the surface scatters; nothing: it does not,
/// or the path may not go on.
std::optional<Bsdf> arrive(const PathContext& context, const SurfacePoint& point,
                           std::uint32_t depth, PathState& path);

/// Adds what the surface sends on of one asked light, and turns the path into a direction that it
/// scatters to; false: there is none. `bsdf`: what arrive() gave.
bool scatter(const PathContext& context, const SurfacePoint& point, const Bsdf& bsdf,
             std::uint32_t depth, PathState& path);

/// All three.
inline bool scatter_at(const PathContext& context, const SurfacePoint& point, std::uint32_t depth,
                       PathState& path) {
  see_surface(context, point, path);
  const std::optional<Bsdf> bsdf = arrive(context, point, depth, path);
  return bsdf && scatter(context, point, *bsdf, depth, path);
}

/// The path leaves the scene: adds what it sees there.
void leave_scene(const PathContext& context, PathState& path);

/// Follows the path along its ray, to scattering `depth` and on until it ends.
void follow(const PathContext& context, std::uint32_t depth, PathState& path);

}  // namespace bandsaw
