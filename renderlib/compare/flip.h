#pragma once

// FLIP, the difference that a viewer sees between two images shown alternately: Andersson et al.
// 2020, "FLIP: A Difference Evaluator for Alternating Images", HPG. HDR-FLIP for images brighter
// than a screen: Andersson et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images",
// Eurographics short papers.

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Viewing condition: the eye is 0.7 m from a monitor that is 0.7 m and 3840 pixels wide.
inline constexpr double kPixelsPerDegree = 67;

/// Returns the error per pixel, in [0, 1]; input values are clamped to [0, 1]. The images MUST have
/// the same size.
Plane flip(const Image& image, const Image& reference, double pixels_per_degree = kPixelsPerDegree);

/// Returns the error per pixel, in [0, 1], of HDR-FLIP (Andersson et al. 2021, section 3). Both
/// images are shown through a film curve at several exposures, and the error is the maximum of
/// flip() over these exposures. The exposures range from that for the maximum of the reference to
/// that for its median. The images MUST have the same size.
Plane hdr_flip(const Image& image, const Image& reference,
               double pixels_per_degree = kPixelsPerDegree);

/// Returns true if any value of the image is above 1, the brightest that a screen shows.
bool beyond_screen(const Image& image);

}  // namespace bandsaw
