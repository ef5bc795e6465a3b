#pragma once

// Flat disks: their own frame of axes, their box, and where a ray meets them.

#include "renderlib/geometry/intersect.h"

namespace bandsaw {

/// Two unit vectors across the normal: (u, v, normal) is right-handed. A disk that faces up (0, 1,
/// 0) has u = x and v = -z.
struct DiskAxes {
  Vec3 u;
  Vec3 v;
};
DiskAxes axes_of(const Disk& disk);

/// A little larger than the disk, by more than the rounding of the test.
Box bounds(const Disk& disk);

/// Crossing::u and v: where on the disk, along its axes, in units of the radius. Both sides count,
/// the rim included. A ray within the plane misses.
bool intersect(const TracedRay& ray, const Disk& disk, Crossing& crossing);

}  // namespace bandsaw
