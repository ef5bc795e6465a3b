#pragma once

// The distance at which a light is asked in a stretch of medium: some of them where light is
// scattered, the others where a light seems to be, as one density (one-sample balance heuristic:
// Veach 1997, section 9.2.4).

#include <algorithm>
#include <optional>

#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/equiangular.h"
#include "renderlib/medium/flight.h"

namespace bandsaw {

class AskedDistance {
 public:
  /// As Flight and Equiangular, whose arguments these are; without a pivot the flight alone. The
  /// flight MUST outlive this, its chance() not be 0.
  AskedDistance(const Flight& flight, const Medium& medium, const Vec3& origin, const Vec3& way,
                double length, const std::optional<Vec3>& pivot)
      : flight_(flight) {
    if (pivot) {
      angles_.emplace(origin, way, length, *pivot);
      // As far as a lamp is in sight distances by its angle are nearly exact; behind many free
      // paths it is the near end that is bright.
      const double depth = mean_extinction(medium) * bandsaw::length(*pivot - origin);
      flown_ = std::clamp(0.5 - 0.5 / (1 + depth), kLeastFlown, 0.5);
    }
  }

  /// In [0, length]; choice, u in [0, 1).
  double sample(double choice, double u) const {
    return choice < flown_ ? flight_.sample(choice / flown_, u) : angles_->sample(u);
  }
  /// By length.
  double pdf(double distance) const {
    const double flown = flight_.pdf(distance);
    return angles_ ? flown_ * flown + (1 - flown_) * angles_->pdf(distance) : flown;
  }

 private:
  static constexpr double kLeastFlown = 0.0625;

  const Flight& flight_;
  std::optional<Equiangular> angles_;
  double flown_ = 1;  ///< share of the samples that are as the flight
};

}  // namespace bandsaw
