#pragma once

// Path tracing of several pixels with path reuse (Bekaert, Sbert and Halton 2002, "Accelerating
// Path Tracing by Re-Using Paths", EGWR). The primary vertex of a path is its first vertex whose
// BSDF has a pdf. Before it, the path may have met mirrors and smooth glass. The light that leaves
// the vertex after the primary one is connected to the primary vertices of the other pixels as
// well.
//
// Let x_j be the primary vertex of pixel j, y_i the vertex after x_i on the path of pixel i, and
// L_i the radiance that leaves y_i. Pixel j samples a point y with this pdf by area:
//
//   p_j(y) = pdf_j(y) cos(y) V / |y - x_j|^2
//
// pdf_j(y) is the pdf, by solid angle, of the direction from x_j to y. cos(y) is the cosine between
// this direction and the normal at y. V is the visibility of y from x_j. Pixel j receives the
// radiance that leaves y, multiplied by this factor:
//
//   f_j(y) = bsdf_j(y) cos(y) V / |y - x_j|^2
//
// bsdf_j(y) is the value of the BSDF at x_j for light from y, times the cosine at x_j. With the
// balance heuristic over the pdfs of all pixels (Veach 1997, section 9.2.2), the vertex y_i
// contributes f_j(y_i) L_i / sum_k p_k(y_i) to x_j. This is multiplied by the throughput from x_j
// to the camera. The expected value of every pixel equals that of `path_radiance()`.
//
// L_i must not depend on the outgoing direction. So only diffuse vertices are shared, and only the
// light that they scatter. All other light stays with the pixel that sampled it.

#include <cstddef>
#include <cstdint>

#include "absl/types/span.h"
#include "renderlib/integrate/path.h"

namespace bandsaw {

/// Maximum number of pixels that share their paths.
inline constexpr std::size_t kMaxReusePixels = 8;

/// One of the pixels that share their paths: inputs and results of one sample.
struct ReusePixel {
  PixelSampler sampler;
  CameraRay camera_ray;  ///< camera ray of this sample
  /// Result: radiance arriving along `camera_ray`; set by `radiance_with_reuse()`.
  Rgb radiance = {};
  /// Result: `radiance_with_reuse()` adds the counts of this pixel's path, and the number of shadow
  /// rays from the primary vertices of other pixels to the shared vertex of this path.
  PathCounts counts = {};
};

/// Computes sample number `sample` of up to kMaxReusePixels pixels. The scene MUST be one that
/// shares paths (`Scene::reuses_paths`), and `options.local` MUST be false. Deterministic;
/// allocates nothing.
void radiance_with_reuse(const Scene& scene, absl::Span<ReusePixel> pixels, std::uint64_t sample,
                         const PathOptions& options);

}  // namespace bandsaw
