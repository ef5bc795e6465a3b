#pragma once

// Flat disks: axes, bounds and the intersection test in double. The tests of other shapes are in
// intersect.h.

#include "renderlib/geometry/intersect.h"

namespace bandsaw {

/// Two perpendicular unit vectors in the plane of the disk; (u, v, normal) is right-handed. A disk
/// that faces up, (0, 1, 0), has u = x and v = -z.
struct DiskAxes {
  Vec3 u;
  Vec3 v;
};
DiskAxes axes_of(const Disk& disk);

/// Returns a box slightly larger than the disk, by more than the rounding error of the test.
Box bounds(const Disk& disk);

/// Returns true and sets `crossing` if the ray hits the disk. Crossing::u and v are the coordinates
/// on the disk along its axes, in units of the radius. Both sides can be hit, and the rim belongs
/// to the disk. A ray within the plane misses.
bool intersect(const TracedRay& ray, const Disk& disk, Crossing& crossing);

}  // namespace bandsaw
