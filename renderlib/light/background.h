#pragma once

// What a ray sees that leaves the scene.

#include "renderlib/math/rgb.h"
#include "renderlib/math/vec.h"

namespace bandsaw {

/// radiance(d) = lerp(bottom, top, (d.y + 1) / 2) for a unit direction d; constant when both are
/// equal.
struct Background {
  Rgb bottom;
  Rgb top;
};

Rgb radiance(const Background& background, const Vec3& unit_direction);

}  // namespace bandsaw
