#pragma once

// Integrators for the guides of the denoiser (integrate/guide.h). Users cannot select them, and no
// scene has them as its default.

#include "renderlib/scene/integrator.h"

namespace bandsaw {

/// The albedo of the first surface that is no mirror and no glass, times the tint of those before
/// it; the background's radiance L as L / (1 + L).
inline constexpr Integrator kGuideAlbedo{9};
/// Its shading normal on the viewer's side, by components to the right and upwards in the
/// camera's view, each as (n + 1) / 2, and the path length to it; (0.5, 0.5, 0) for a
/// miss.
inline constexpr Integrator kGuideShape{10};
inline constexpr int kLastGuideIntegrator = 10;

constexpr bool is_guide(Integrator integrator) {
  return integrator == kGuideAlbedo || integrator == kGuideShape;
}

}  // namespace bandsaw
