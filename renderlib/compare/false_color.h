#pragma once

// False-colour images of errors.

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Maps each value of [0, 1] to a colour from black over violet, red and yellow to white, of
/// increasing lightness: linear RGB for an 8-bit file.
Image false_color(const Plane& values);

}  // namespace bandsaw
