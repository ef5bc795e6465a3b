#pragma once

// Integrators for the guides of the denoiser (integrate/guide.h). Users cannot select them, and no
// scene has them as its default.

#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// The albedo of the first surface that is no mirror and no glass, times the tint of the mirrors
/// and panes before it. If there is no such surface: L / (1 + L), L the background's radiance.
inline constexpr Integrator kGuideAlbedo{10};
/// (x, y, d): components of that surface's shading normal to the right and upwards in the camera's
/// view, each as (n + 1) / 2, and the path length d to the surface. No such surface: (0.5, 0.5, 0).
inline constexpr Integrator kGuideShape{11};
inline constexpr int kLastGuideIntegrator = 11;

constexpr bool is_guide(Integrator integrator) {
  return integrator == kGuideAlbedo || integrator == kGuideShape;
}

}  // namespace bandsaw
