#pragma once

#include "renderlib/math/vec.h"

namespace bandsaw {

/// The directions whose angle to an axis is at most the cone's half-angle, which is less than 90
/// degrees. An example is a cone that contains the directions from a point to a lens.
struct Cone {
  Vec3 axis;       ///< unit
  double sin = 0;  ///< sine of the half-angle
  double cos = 1;  ///< cosine of the half-angle

  /// Returns true if `direction`, of any length except 0, lies within the cone.
  bool contains(const Vec3& direction) const {
    const double along = dot(axis, direction);
    return along > 0 && along * along >= cos * cos * length_squared(direction);
  }
};

}  // namespace bandsaw
