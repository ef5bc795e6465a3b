#pragma once

// The colour and feature pipelines of FLIP. Sections and equations refer to Andersson et al. 2020
// (compare/flip.h).

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns the colour difference of section 4.1, equation 9, in [0, 1]. Input colours are in [0,
/// 1].
Plane flip_color(const Image& image, const Image& reference, double pixels_per_degree);

/// Returns the difference of edges and points of section 4.2, equation 12, in [0, 1].
Plane flip_features(const Image& image, const Image& reference, double pixels_per_degree);

}  // namespace bandsaw
