#pragma once

// Distances along a ray that a point beside it sees at equal angles: the density follows 1 / r^2,
// the light of a small lamp there (Kulla and Fajardo 2012, "Importance Sampling Techniques for Path
// Tracing in Participating Media", section 4.1).

#include "renderlib/math/vec.h"

namespace bandsaw {

class Equiangular {
 public:
  Equiangular() = default;
  /// Over [0, length] (> 0, maybe infinite) along the unit direction `way` from `origin`, as
  /// `pivot`, a finite point, sees it. A pivot nearly on the ray counts as beside it by a millionth
  /// of the lengths around, so that the density is finite everywhere.
  Equiangular(const Vec3& origin, const Vec3& way, double length, const Vec3& pivot);

  /// Where, in [0, length], finite; u in [0, 1).
  double sample(double u) const;
  /// The density of sample() there, by length.
  double pdf(double distance) const;

 private:
  double length_ = 0;
  double start_ = 0;  ///< of the stretch, from the point nearest to the pivot
  double aside_ = 1;  ///< distance of the pivot from the ray
  double angle_ = 0;  ///< of the stretch, as the pivot sees it
};

}  // namespace bandsaw
