#pragma once

// Ray intersection that skips surfaces which are not there: holes cut by alpha, and hidden
// boundaries, which are boundaries of a glass inside a glass of higher priority.

#include <cstdint>
#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/material/interiors.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// The glasses that contain the current segment of a path (`here`), and the glasses beyond the
/// surface that the path hits next (`beyond`).
struct NestedDielectrics {
  Interiors here;
  Interiors beyond;  ///< set if the hit surface belongs to a nested glass (material/interiors.h)
  bool skipped_hidden = false;  ///< true if hidden boundaries were skipped before the hit
  Interiors before;             ///< glasses at the start of the ray; set if `skipped_hidden`
};

/// Returns the first surface along the ray that exists for this sample; std::nullopt if nothing is
/// hit. Among hits that exist, the order (t, instance, primitive) decides. Updates `nesting` for
/// all hidden boundaries that are skipped. A ray that leaves a surface starts at a small offset
/// from it. Two boundaries of nested glasses touch if a ray that leaves the first boundary starts
/// beyond the second. Boundaries that touch count as a single boundary. The result is then the
/// surface of that glass which is present on one side of the single boundary and absent on the
/// other side. uv directions are set if the material needs them. `bounce` is the number of
/// scatterings before the ray (0: a camera ray), which selects the random numbers. Adds the number
/// of rays traced to `rays`.
std::optional<SurfacePoint> intersect_visible(const Scene& scene, const Ray& ray,
                                              const PixelSampler& sampler, std::uint64_t sample,
                                              std::uint32_t bounce, NestedDielectrics& nesting,
                                              std::uint64_t& rays);

/// Sets the directions in which u and v grow, or the derivatives of the position by u and v, if the
/// material of the point needs them.
void add_directions(const Scene& scene, SurfacePoint& point);

}  // namespace bandsaw
