#pragma once

// The distance at which a light is asked in a stretch of medium: half of them where light is
// scattered, half where a light seems to be, as one density (one-sample balance heuristic: Veach
// 1997, section 9.2.4).

#include <optional>

#include "renderlib/medium/equiangular.h"
#include "renderlib/medium/flight.h"

namespace bandsaw {

class AskedDistance {
 public:
  /// As Flight and Equiangular, whose arguments these are; without a pivot the flight alone. The
  /// flight MUST outlive this, its chance() not be 0.
  AskedDistance(const Flight& flight, const Vec3& origin, const Vec3& way, double length,
                const std::optional<Vec3>& pivot)
      : flight_(flight) {
    if (pivot) {
      angles_.emplace(origin, way, length, *pivot);
    }
  }

  /// In [0, length]; choice, u in [0, 1).
  double sample(double choice, double u) const {
    if (!angles_) {
      return flight_.sample(choice, u);
    }
    return choice < 0.5 ? flight_.sample(2 * choice, u) : angles_->sample(u);
  }
  /// By length.
  double pdf(double distance) const {
    const double flown = flight_.pdf(distance);
    return angles_ ? 0.5 * (flown + angles_->pdf(distance)) : flown;
  }

 private:
  const Flight& flight_;
  std::optional<Equiangular> angles_;
};

}  // namespace bandsaw
