// Computes u and v of a direction from two angles. Clamping keeps the results in range where u
// wraps around and at the poles.

#include "renderlib/geometry/sphere_uv.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {

Vec2 sphere_uv(const Vec3& unit) {
  const double u = 0.5 + atan2(-unit.z, unit.x) * (0.5 * kInvPi);
  const double v = atan2(std::sqrt(unit.x * unit.x + unit.z * unit.z), -unit.y) * kInvPi;
  return {u < 1 ? std::max(u, 0.0) : 0, std::min(v, 1.0)};
}

}  // namespace bandsaw
