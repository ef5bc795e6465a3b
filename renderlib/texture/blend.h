#pragma once

// Interpolation between colours, for the filters of images and for procedural textures.

#include "renderlib/math/rgb.h"

namespace bandsaw {

/// Returns a + (b - a) t. If a == b, the result is a, to the bit.
inline Rgb blend(const Rgb& a, const Rgb& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t};
}

}  // namespace bandsaw
