#pragma once

// The distance at which a light is asked in a stretch of medium: some of them where light is
// scattered, the others where lights seem to be, as one density (one-sample balance heuristic:
// Veach 1997, section 9.2.4).

#include <algorithm>
#include <array>
#include <cstddef>

#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/equiangular.h"
#include "renderlib/medium/flight.h"

namespace bandsaw {

class AskedDistance {
 public:
  /// More pivots than these are not taken.
  static constexpr std::size_t kMostPivots = 4;

  /// The flight MUST outlive this, its chance() not be 0. Until a pivot is added distances are
  /// those of the flight.
  AskedDistance(const Flight& flight, const Medium& medium)
      : flight_(flight), extinction_(mean_extinction(medium)) {}

  /// A point of a light, over the stretch that Equiangular's other arguments say; each counts
  /// alike.
  void add(const Vec3& origin, const Vec3& way, double length, const Vec3& pivot) {
    if (pivots_ == kMostPivots) {
      return;
    }
    angles_[size_] = Equiangular(origin, way, length, pivot);
    // As far as a lamp is in sight distances by its angle are nearly exact; behind many free paths
    // it is the near end that is bright.
    const double depth = extinction_ * bandsaw::length(pivot - origin);
    const double flown = std::clamp(0.5 - 0.5 / (1 + depth), kLeastFlown, 0.5);
    share_[size_++] = 1 - flown;
    flown_ += flown;
    ++pivots_;
  }
  /// A light without a place: as bright everywhere.
  void add_distant() {
    if (pivots_ < kMostPivots) {
      flown_ += 1;
      ++pivots_;
    }
  }

  /// In [0, length]; choice, u in [0, 1).
  double sample(double choice, double u) const {
    double left = choice * static_cast<double>(std::max<std::size_t>(pivots_, 1));
    for (std::size_t i = 0; i < size_; ++i) {
      if (left < share_[i]) {
        return angles_[i].sample(u);
      }
      left -= share_[i];
    }
    const double flown = pivots_ == 0 ? 1 : flown_;
    return flight_.sample(std::min(left / flown, 1 - 0x1p-53), u);
  }
  /// By length.
  double pdf(double distance) const {
    if (size_ == 0) {
      return flight_.pdf(distance);
    }
    double sum = flown_ * flight_.pdf(distance);
    for (std::size_t i = 0; i < size_; ++i) {
      sum += share_[i] * angles_[i].pdf(distance);
    }
    return sum / static_cast<double>(pivots_);
  }

 private:
  static constexpr double kLeastFlown = 0.0625;

  const Flight& flight_;
  double extinction_;
  std::array<Equiangular, kMostPivots> angles_;
  std::array<double, kMostPivots> share_{};
  std::size_t size_ = 0;    ///< of both
  std::size_t pivots_ = 0;  ///< distant ones, too
  double flown_ = 0;        ///< share of the flight, of as many as there are pivots
};

}  // namespace bandsaw
