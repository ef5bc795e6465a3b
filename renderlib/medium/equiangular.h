#pragma once

// Equiangular sampling of distances along a ray, for light sampling in homogeneous media: the pdf
// is proportional to 1 / r^2, where r is the distance to the pivot, a point on a light (Kulla and
// Fajardo 2012, "Importance Sampling Techniques for Path Tracing in Participating Media",
// section 4.1).

#include "renderlib/math/vec.h"

namespace bandsaw {

class Equiangular {
 public:
  Equiangular() = default;
  /// Samples distances in [0, length] from `origin` along the unit vector `direction`, for the
  /// finite point `pivot`. `length` is > 0 and may be infinite. If the pivot is very near the ray,
  /// its distance from the ray is raised to a minimum, so that the pdf is finite. The minimum is a
  /// millionth of the larger of two lengths: `length`, if finite, and the pivot's distance from
  /// `origin` along the ray.
  Equiangular(const Vec3& origin, const Vec3& direction, double length, const Vec3& pivot);

  /// Returns a finite distance in [0, length]; u in [0, 1).
  double sample(double u) const;
  /// Returns the pdf of `sample()` with respect to length.
  double pdf(double distance) const;

 private:
  double length_ = 0;
  /// Signed distance of the segment's start from the point of the ray closest to the pivot.
  double start_ = 0;
  double aside_ = 1;  ///< distance of the pivot from the ray
  double angle_ = 0;  ///< angle that the segment subtends at the pivot
};

}  // namespace bandsaw
