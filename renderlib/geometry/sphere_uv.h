#pragma once

#include "renderlib/math/vec.h"

namespace bandsaw {

/// Returns the uv coordinates of a unit vector on a sphere: u = (pi + atan2(-z, x)) / (2 pi) in [0,
/// 1), v = (angle from the pole -y) / pi in [0, 1]. So an image of the earth with north up has its
/// north at +y and is not mirrored, as in "Ray Tracing: The Next Week", chapter 4.
Vec2 sphere_uv(const Vec3& unit);

}  // namespace bandsaw
