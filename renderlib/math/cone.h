#pragma once

#include "renderlib/math/vec.h"

namespace bandsaw {

/// The directions that are at most an angle below 90 degrees away from an axis.
struct Cone {
  Vec3 axis;       ///< unit
  double sin = 0;  ///< of the angle
  double cos = 1;

  /// Of any length but 0.
  bool contains(const Vec3& way) const {
    const double along = dot(axis, way);
    return along > 0 && along * along >= cos * cos * length_squared(way);
  }
};

}  // namespace bandsaw
