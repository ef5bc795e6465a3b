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
/// hit. Among hits that exist, the order (t, instance, primitive) decides. The uv directions of the
/// surface are set if its material needs them. Updates `nesting` for all hidden boundaries that are
/// skipped. `bounce` is the number of scatterings before the ray (0: a camera ray), which selects
/// the random numbers. Adds the number of rays traced to `rays`.
///
/// Boundaries of nested glasses may be so close that a ray from the first one starts beyond the
/// second, because rays start at a small offset from a surface. Such boundaries count as one
/// boundary between the glasses before the first and the glasses after the last. The result is the
/// surface of the glass in which these two sets differ.
std::optional<SurfacePoint> intersect_visible(const Scene& scene, const Ray& ray,
                                              const PixelSampler& sampler, std::uint64_t sample,
                                              std::uint32_t bounce, NestedDielectrics& nesting,
                                              std::uint64_t& rays);

/// Sets the directions in which u and v grow, or the derivatives of the position by u and v, if the
/// material of the point needs them.
void add_directions(const Scene& scene, SurfacePoint& point);

}  // namespace bandsaw
