#pragma once

// Rotations as unit quaternions, for turning evenly from one into another.

#include "renderlib/math/transform.h"

namespace bandsaw {

struct Quaternion {
  double w = 1;
  double x = 0;
  double y = 0;
  double z = 0;
  friend bool operator==(const Quaternion&, const Quaternion&) = default;
};

/// Of a rotation matrix (the linear part of `t`); unit (Shepperd 1978, "Quaternion from Rotation
/// Matrix": the largest component first, so nothing cancels).
Quaternion quaternion(const Transform& t);
/// The rotation matrix of a unit quaternion.
Transform rotation(const Quaternion& q);
/// How far a is turned to become b by the shorter way, in turns: [0, 0.5].
double turn_between(const Quaternion& a, const Quaternion& b);
/// From a (u = 0) to b (u = 1) by the shorter way at constant speed (Shoemake 1985, "Animating
/// Rotation with Quaternion Curves", section 3.3).
Quaternion slerp(const Quaternion& a, const Quaternion& b, double u);

}  // namespace bandsaw
