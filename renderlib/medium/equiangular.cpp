// Distances along a ray are sampled with a density proportional to 1 / r^2, where r is the distance
// from the pivot. So they are sampled uniformly in the angle under which the pivot sees the ray.

#include "renderlib/medium/equiangular.h"

#include <algorithm>
#include <cmath>

#include "renderlib/math/constants.h"
#include "renderlib/math/elementary.h"

namespace bandsaw {

Equiangular::Equiangular(const Vec3& origin, const Vec3& direction, double length,
                         const Vec3& pivot)
    : length_(length) {
  const Vec3 to_pivot = pivot - origin;
  const double nearest = dot(to_pivot, direction);
  start_ = -nearest;
  const double finite_length = std::isfinite(length) ? length : 0;
  // 1e-94 keeps the squares of `aside_` above underflow if the other lengths are 0.
  const double least = 1e-6 * std::max({finite_length, std::abs(nearest), 1e-94});
  aside_ = std::max(bandsaw::length(to_pivot - direction * nearest), least);
  // The angle is the difference of two arctangents. It is computed as a single arctangent, without
  // cancellation.
  angle_ = std::isfinite(length)
               ? atan2(aside_ * length, aside_ * aside_ + start_ * (start_ + length))
               : atan2(aside_, start_);
}

double Equiangular::sample(double u) const {
  const SinCos turn = sincos_turns(u * angle_ / (2 * kPi));
  const double divisor = aside_ * turn.cos - start_ * turn.sin;
  const double distance = (aside_ * aside_ + start_ * start_) * turn.sin / divisor;
  // Rounding at the far end may make the divisor 0 or negative. kFarthest stands for infinity,
  // because the result must be finite.
  constexpr double kFarthest = 1e30;
  const double farthest = std::min(length_, kFarthest);
  return divisor > 0 && distance <= farthest ? std::max(distance, 0.0) : farthest;
}

double Equiangular::pdf(double distance) const {
  const double along = start_ + distance;
  return aside_ / (angle_ * (aside_ * aside_ + along * along));
}

}  // namespace bandsaw
