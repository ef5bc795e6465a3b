#pragma once

// Axis-aligned bounding boxes in double, and the clipping of hits to them.

#include <algorithm>

#include "renderlib/geometry/traced_ray.h"

namespace bandsaw {

/// A box, empty by default.
struct Box {
  Vec3 lo{kInfinity, kInfinity, kInfinity};
  Vec3 hi{-kInfinity, -kInfinity, -kInfinity};

  void add(const Vec3& p) {
    lo = {std::min(lo.x, p.x), std::min(lo.y, p.y), std::min(lo.z, p.z)};
    hi = {std::max(hi.x, p.x), std::max(hi.y, p.y), std::max(hi.z, p.z)};
  }
  bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
};

/// Moves the distance t of a hit into the part of the ray that is inside the primitive's box from
/// `lo` to `hi`. Returns false if the ray misses the box by more than a tolerance of 2^-40 of t.
/// This tolerance is far above the rounding error of the primitive tests and far below the
/// tolerance of a BVH's boxes.
///
/// Every primitive test calls this function. Without the function, a hit whose t is mostly rounding
/// error (on a triangle seen edge-on) could lie outside the boxes of a BVH, and the tree would
/// decide whether the hit is found.
inline bool clip_to_box(const TracedRay& ray, const double (&lo)[3], const double (&hi)[3],
                        double& t) {
  constexpr double kGrow = 1 + 0x1p-40;
  double enter = 0;
  double leave = kInfinity;
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = (lo[k] - ray.origin[k]) * ray.inverse[k];
    const double b = (hi[k] - ray.origin[k]) * ray.inverse[k];
    // 0 * infinity, for a ray within the plane of a face, is NaN and bounds nothing.
    const double first = ray.inverse[k] < 0 ? b : a;
    const double last = ray.inverse[k] < 0 ? a : b;
    enter = first > enter ? first : enter;
    leave = last < leave ? last : leave;
  }
  if (!(enter <= leave * kGrow)) {
    return false;
  }
  t = t < enter ? enter : t > leave ? leave : t;
  return true;
}

}  // namespace bandsaw
