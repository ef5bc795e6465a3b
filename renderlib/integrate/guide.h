#pragma once

// Guides of the denoiser: albedo, normal and distance of the first surface that is not a mirror,
// smooth glass, a pane or nearly smooth metal. These images have hardly any noise, and the denoiser
// finds edges by them. A sample of a guide is the mean of several camera rays: few where the
// surface around the pixel is even, and many at edges.

#include <cstdint>

#include "absl/functional/function_ref.h"
#include "renderlib/integrate/path.h"
#include "renderlib/scene/guide_integrators.h"

namespace bandsaw {

/// Returns the value of one camera ray of a guide. `integrator` MUST be kGuideAlbedo or
/// kGuideShape. For kGuideAlbedo, the value is the albedo of the surface, times the tint of the
/// mirrors and panes before it. For kGuideShape, it is two coordinates of the normal, to the right
/// and upwards in the camera's view, and the length of the path. If the path leaves the scene, the
/// value for kGuideShape is (0.5, 0.5, 0). For kGuideAlbedo it is L / (1 + L), where L is the
/// background's radiance times the tint. Follows the path through mirrors, smooth glass, panes and
/// nearly smooth metal, at most kMaxGuideBounces times. In glass and panes it follows the brighter
/// of reflection and refraction, otherwise the random numbers of sample `number`. All values are >=
/// 0. Adds the number of rays to `rays`.
Rgb guide_value(const Scene& scene, Integrator integrator, const Ray& ray,
                const PixelSampler& sampler, std::uint64_t number, std::uint64_t& rays);

/// Returns camera ray `number` of a pixel. Its place in the pixel is sampled from the pixel filter.
/// If `spread` is not 1, the distance from the centre of the pixel is multiplied by it.
using GuideCamera = absl::FunctionRef<Ray(std::uint64_t number, double spread)>;

/// Returns the value of sample `sample` of a guide: the mean of guide_value() over camera rays of a
/// pixel. The first kProbeGuideRays rays also cover the pixels around (kProbeSpread). If their
/// values are alike, their mean is the result. Otherwise the pixel may have an edge, and the result
/// is the mean of kSomeGuideRays rays within the pixel, or of kMaxGuideRays if their values differ
/// much. Adds the number of rays to `rays`.
Rgb guide_sample(const Scene& scene, Integrator integrator, const PixelSampler& sampler,
                 std::uint64_t sample, GuideCamera camera, std::uint64_t& rays);

inline constexpr std::uint64_t kProbeGuideRays = 4;
inline constexpr std::uint64_t kSomeGuideRays = 8;
inline constexpr std::uint64_t kMaxGuideRays = 32;
inline constexpr double kProbeSpread = 2;
inline constexpr std::uint32_t kMaxGuideBounces = 8;
/// In metal of at most this fuzz, the guide shows the reflection and not the metal itself.
inline constexpr double kMaxGuideFuzz = 0.1;

}  // namespace bandsaw
