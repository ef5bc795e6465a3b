#pragma once

// A picture of where an image differs from a reference.

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Each value of [0, 1] as a colour from black over violet, red and yellow to white, brighter for
/// more: linear RGB for an 8-bit file.
Image false_color(const Plane& values);

}  // namespace bandsaw
