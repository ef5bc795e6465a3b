#pragma once

// Rotations as unit quaternions w + x i + y j + z k, for the interpolation of animated placements
// (geometry/frame.h).

#include "renderlib/math/transform.h"

namespace bandsaw {

struct Quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// Returns the unit quaternion of a rotation matrix, the linear part of `t` (Shepperd 1978,
/// "Quaternion from Rotation Matrix"). The largest component is computed first, so nothing cancels.
Quaternion quaternion(const Transform& t);
/// Returns the rotation matrix of a unit quaternion.
Transform rotation(const Quaternion& q);
/// Returns the angle of the shorter rotation from a to b, in turns: [0, 0.5].
double turn_between(const Quaternion& a, const Quaternion& b);
/// Interpolates from a (u = 0) to b (u = 1) along the shorter arc at constant speed (Shoemake 1985,
/// "Animating Rotation with Quaternion Curves", section 3.3).
Quaternion slerp(const Quaternion& a, const Quaternion& b, double u);

}  // namespace bandsaw
