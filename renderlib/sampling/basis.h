#pragma once

// Orthonormal bases around a direction. They turn directions that are sampled around z
// (sampling/warp.h) into world space.

#include "renderlib/math/vec.h"

namespace bandsaw {

struct Basis {
  Vec3 x;
  Vec3 y;
  Vec3 z;

  Vec3 to_world(const Vec3& local) const { return x * local.x + y * local.y + z * local.z; }
  Vec3 to_local(const Vec3& world) const { return {dot(x, world), dot(y, world), dot(z, world)}; }
};

/// Returns a right-handed basis whose z is the unit vector n (Duff et al. 2017, "Building an
/// Orthonormal Basis, Revisited", JCGT 6(1), listing 3). The sign of n.z is the only special case.
inline Basis orthonormal_basis(const Vec3& n) {
  const double sign = std::copysign(1.0, n.z);
  const double a = -1.0 / (sign + n.z);
  const double b = n.x * n.y * a;
  return {{1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x}, {b, sign + n.y * n.y * a, -n.y}, n};
}

}  // namespace bandsaw
