#pragma once

// Integrators for the guides of the denoiser: images of surfaces with hardly any noise, by which
// the denoiser finds edges (integrate/guide.h). Users cannot select these integrators, and no scene
// has one of them as its default.

#include <cstdint>

#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// The albedo of the first surface that is no mirror and no glass, times the tint of the mirrors
/// and panes before it. If there is no such surface, the value is L / (1 + L), where L is the
/// background's radiance.
inline constexpr Integrator kGuideAlbedo{10};
/// Three values (x, y, d) of the surface that kGuideAlbedo uses. x is (n + 1) / 2, where n is the
/// component of the surface's shading normal towards the right of the camera's view. For y, n is
/// the component upwards in the view. d is the path length to the surface. If there is no such
/// surface, the values are (0.5, 0.5, 0).
inline constexpr Integrator kGuideShape{11};
inline constexpr int kLastGuideIntegrator = 11;

/// The number of samples per pixel of a guide. A sample takes as many camera rays as the pixel needs
/// (guide_sample in integrate/guide.h).
inline constexpr std::uint64_t kGuideSamples = 1;

constexpr bool is_guide(Integrator integrator) {
  return integrator == kGuideAlbedo || integrator == kGuideShape;
}

}  // namespace bandsaw
