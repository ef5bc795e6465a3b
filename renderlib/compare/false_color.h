#pragma once

// False-colour images of errors.

#include "renderlib/compare/plane.h"
#include "renderlib/image/image.h"

namespace bandsaw {

/// Returns an image in linear RGB that shows each value by a colour: from black at 0 over violet,
/// red and yellow to nearly white at 1, in even steps of lightness. Values outside of [0, 1] are
/// clamped. If the image is stored as 8-bit sRGB, its colours are exactly the
/// intended ones.
Image false_color(const Plane& values);

}  // namespace bandsaw
