// Intersects the plane of the disk and checks the distance from its centre. The hit is then moved
// into the disk's box (box.h, clip_to_box).

#include "renderlib/geometry/disk.h"

#include <algorithm>
#include <cmath>

namespace bandsaw {
namespace {

/// Margin of the box around the disk, relative to the largest number involved: 2^9 units of
/// rounding (2^-53), far more than the rounding errors of the test.
constexpr double kMargin = 0x1p-44;

}  // namespace

DiskAxes axes_of(const Disk& disk) {
  const Vec3& n = disk.normal;
  // u is perpendicular to the normal and to z, or to y instead of z if the normal is close to z.
  const bool steep = std::abs(n.z) > 0.9 * length(n);
  const Vec3 u = normalize(steep ? cross(Vec3{0, 1, 0}, n) : cross(n, Vec3{0, 0, 1}));
  return {u, cross(normalize(n), u)};
}

Box bounds(const Disk& disk) {
  const double margin = kMargin * (disk.radius + max_abs(disk.center));
  // Along x the disk extends from its centre by radius * sqrt(1 - n.x^2), which is equal to
  // radius * sqrt(n.y^2 + n.z^2). The second form does not cancel if the normal is almost along x.
  const auto reach = [&](double a, double b) {
    return disk.radius * std::sqrt(a * a + b * b) + margin;
  };
  const Vec3 n = normalize(disk.normal);
  const Vec3 half = {reach(n.y, n.z), reach(n.z, n.x), reach(n.x, n.y)};
  return {disk.center - half, disk.center + half};
}

bool intersect(const TracedRay& ray, const Disk& disk, Crossing& crossing) {
  const Vec3 f = Vec3{ray.origin[0], ray.origin[1], ray.origin[2]} - disk.center;
  const Vec3 d = {ray.direction[0], ray.direction[1], ray.direction[2]};
  double t = -dot(f, disk.normal) / dot(d, disk.normal);
  if (!(t > 0 && std::isfinite(t))) {
    return false;
  }
  const Vec3 p = f + t * d;
  if (!(length_squared(p) <= disk.radius * disk.radius)) {
    return false;
  }
  const Box box = bounds(disk);
  const double lo[3] = {box.lo.x, box.lo.y, box.lo.z};
  const double hi[3] = {box.hi.x, box.hi.y, box.hi.z};
  if (!clip_to_box(ray, lo, hi, t) || !(t > 0 && t < ray.t_max)) {
    return false;
  }
  const DiskAxes axes = axes_of(disk);
  const double scale = 1 / disk.radius;
  crossing = {t, std::clamp(dot(p, axes.u) * scale, -1.0, 1.0),
              std::clamp(dot(p, axes.v) * scale, -1.0, 1.0)};
  return true;
}

}  // namespace bandsaw
