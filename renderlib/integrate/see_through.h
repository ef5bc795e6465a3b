#pragma once

// Rays through what is not there: surfaces that alpha makes holes in, and boundaries of glass
// inside a glass of higher priority.

#include <cstdint>
#include <optional>

#include "renderlib/geometry/surface.h"
#include "renderlib/material/interiors.h"
#include "renderlib/sampling/sampler.h"
#include "renderlib/scene/scene.h"

namespace bandsaw {

/// Which glasses a path is inside of where it goes, and beyond the surface that it meets next.
struct Nesting {
  Interiors here;
  Interiors beyond;  ///< set where that surface is of a nested glass (material/interiors.h)
  bool passed_unseen = false;  ///< whether boundaries were passed unseen on the way there
  Interiors before;            ///< set where there were: which it was inside of where the way began
};

/// The first surface along the ray that is there for this sample: (t, instance, primitive) still
/// decides between those that are. Keeps account of boundaries that are passed unseen, all the way.
/// Boundaries of nested glasses that touch are one: of the glass that is there on one side of all
/// of them. uv directions are set where the material needs them.
std::optional<SurfacePoint> first_surface(const Scene& scene, const Ray& ray,
                                          const PixelSampler& sampler, std::uint64_t sample,
                                          std::uint32_t bounce, Nesting& nesting,
                                          std::uint64_t& rays);

/// The share of light that passes along the ray: 0 or 1 but for blended surfaces.
float unoccluded(const Scene& scene, const Ray& ray, std::uint64_t& rays);

}  // namespace bandsaw
