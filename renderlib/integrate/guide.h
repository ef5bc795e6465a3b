#pragma once

// Guides of the denoiser: albedo, normal and distance of the first surface that is not a mirror,
// smooth glass, a pane or nearly smooth metal. These images have hardly any noise, and the denoiser
// finds edges by them.

#include <cstdint>

#include "renderlib/integrate/path.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw {

/// Returns the value of a sample of a guide. `integrator` MUST be kGuideAlbedo or kGuideShape. For
/// kGuideAlbedo, the value is the albedo of the surface, times the tint of the mirrors and panes
/// before it. For kGuideShape, it is two coordinates of the normal, to the right and upwards in the
/// camera's view, and the length of the path. If the path leaves the scene, the value for
/// kGuideShape is (0.5, 0.5, 0). For kGuideAlbedo it is L / (1 + L), where L is the background's
/// radiance times the tint. Follows the path through mirrors, smooth glass, panes and nearly smooth
/// metal, at most kMaxGuideBounces times. In glass and panes it follows the brighter of reflection
/// and refraction. All values are >= 0. Adds the number of rays to `rays`.
Rgb guide_value(const Scene& scene, Integrator integrator, const Ray& ray,
                const PixelSampler& sampler, std::uint64_t sample, std::uint64_t& rays);

inline constexpr std::uint32_t kMaxGuideBounces = 8;
/// In metal of at most this fuzz, the guide shows the reflection and not the metal itself.
inline constexpr double kMaxGuideFuzz = 0.1;

}  // namespace bandsaw
