#pragma once

// Path tracing of several pixels at once that share what their paths find: the light that one
// path's second surface sends out reaches what the other pixels see as well (Bekaert, Sbert, Halton
// 2002, "Accelerating Path Tracing by Re-Using Paths", EGWR).
//
// Let x_j be what pixel j sees first and y_i what the path of pixel i meets next, where L_i comes
// back. Pixel i makes y with the density p_i(y) = pdf(x_i to y) cos(y) V / |y - x_i|^2 by area, V:
// y is in sight. Taken as samples of all pixels' densities together (balance heuristic: Veach 1997,
// section 9.2.2), y_i adds f_j(y_i) L_i / sum_k p_k(y_i) to pixel j, f_j as p_j but with the value
// of x_j's surface in place of its pdf. Every pixel's mean is that of path_radiance. L_i must not
// depend on where it goes to: only diffuse y are shared, and of those only the light that they
// scatter. Everything else stays with the pixel that found it.

#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/integrate/path.h"

namespace bandsaw {

/// Pixels that share at most.
inline constexpr std::size_t kMostShared = 8;

struct SharedPixel {
  PixelSampler sampler;
  CameraRay camera_ray;  ///< of the sample
  Rgb radiance = {};     ///< that comes back along it; set by shared_radiance
};

/// One sample, number `sample`, of each of up to kMostShared pixels. The scene MUST share paths
/// (Scene::shares_paths), options.local MUST be false. Adds to `counts`.
/// Deterministic, allocates nothing.
void shared_radiance(const Scene& scene, absl::Span<SharedPixel> pixels, std::uint64_t sample,
                     const PathOptions& options, PathCounts& counts);

}  // namespace bandsaw
