#pragma once

// A ray with precomputed values for the primitive tests of intersect.h: axes and shear of the
// triangle test (Woop, Benthin, Wald 2013), and reciprocals for boxes.

#include <array>
#include <cmath>

#include "renderlib/geometry/ray.h"

namespace bandsaw {

struct TracedRay {
  std::array<double, 3> origin;
  std::array<double, 3> direction;
  std::array<double, 3> inverse;  ///< 1 / direction; infinite where the direction is 0
  double t_max;
  /// kz is the axis along which the direction is longest. kx and ky are the next two axes in cyclic
  /// order, swapped if direction[kz] is negative. So the winding of triangles is preserved.
  int kx;
  int ky;
  int kz;
  double shear_x;  ///< direction[kx] / direction[kz]
  double shear_y;  ///< direction[ky] / direction[kz]
  double shear_z;  ///< 1 / direction[kz]
};

/// Prepares a ray, which MUST be traceable (is_traceable).
inline TracedRay trace_setup(const Vec3& origin, const Vec3& direction, double t_max) {
  TracedRay r;
  r.origin = {origin.x, origin.y, origin.z};
  r.direction = {direction.x, direction.y, direction.z};
  for (std::size_t k = 0; k < 3; ++k) {
    r.inverse[k] = 1 / r.direction[k];
  }
  r.t_max = t_max;
  const double ax = std::abs(direction.x);
  const double ay = std::abs(direction.y);
  const double az = std::abs(direction.z);
  r.kz = ax > ay ? (ax > az ? 0 : 2) : (ay > az ? 1 : 2);
  r.kx = r.kz == 2 ? 0 : r.kz + 1;
  r.ky = r.kx == 2 ? 0 : r.kx + 1;
  if (r.direction[static_cast<std::size_t>(r.kz)] < 0) {
    const int swapped = r.kx;  // preserves the winding
    r.kx = r.ky;
    r.ky = swapped;
  }
  r.shear_z = r.inverse[static_cast<std::size_t>(r.kz)];
  r.shear_x = r.direction[static_cast<std::size_t>(r.kx)] * r.shear_z;
  r.shear_y = r.direction[static_cast<std::size_t>(r.ky)] * r.shear_z;
  return r;
}

/// Returns true if the ray can hit anything: it is finite, t_max is positive, and the direction's
/// largest component is within (2^-500, 2^500), so that its square does not overflow or underflow.
inline bool is_traceable(const Ray& ray) {
  const double size = max_abs(ray.direction);
  return is_finite(ray.origin) && is_finite(ray.direction) && size > 0x1p-500 && size < 0x1p500 &&
         ray.t_max > 0;
}

}  // namespace bandsaw
