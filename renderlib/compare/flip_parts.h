#pragma once

// The two halves of FLIP: what colours and what edges and points differ by. Sections and equations
// are those of Andersson et al. 2020 (compare/flip.h).

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Section 4.1, equation 9: in [0, 1]. Colours in [0, 1].
Plane flip_color(const Image& image, const Image& reference, double pixels_per_degree);

/// Section 4.2, equation 12: in [0, 1].
Plane flip_features(const Image& image, const Image& reference, double pixels_per_degree);

}  // namespace bandsaw
