#pragma once

// How different two pictures look when one flips between them: Andersson et al. 2020, "FLIP: A
// Difference Evaluator for Alternating Images", HPG; of pictures brighter than a screen: Andersson
// et al. 2021, "Visualizing Errors in Rendered High Dynamic Range Images", Eurographics short
// papers.

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Of an observer 0.7 m from a monitor of 3840 pixels on 0.7 m.
inline constexpr double kPixelsPerDegree = 67;

/// Per pixel, in [0, 1]; values beyond [0, 1] are cut off first. The images MUST be of one size.
Plane flip(const Image& image, const Image& reference, double pixels_per_degree = kPixelsPerDegree);

/// The largest over the exposures that show the reference's brightest and its middle, through a
/// film curve (section 3).
Plane hdr_flip(const Image& image, const Image& reference,
               double pixels_per_degree = kPixelsPerDegree);

/// Whether anything of the picture is brighter than a screen.
bool beyond_screen(const Image& image);

}  // namespace bandsaw
