#pragma once

// Samples the distance for light sampling in a segment of a medium. The pdf is a mixture of
// free-flight sampling and of equiangular sampling towards up to four pivots, which are points on
// lights. All strategies are evaluated as one pdf (one-sample model with the balance heuristic:
// Veach 1997, section 9.2.4).

#include <algorithm>
#include <array>
#include <cstddef>

#include "renderlib/medium/attenuation.h"
#include "renderlib/medium/equiangular.h"
#include "renderlib/medium/free_flight.h"

namespace bandsaw {

/// Mixture pdf of the distance at which light is sampled in one segment. through_media.cpp makes
/// one for each homogeneous segment.
class LightDistanceSampler {
 public:
  /// Maximum number of pivots; further ones are ignored.
  static constexpr std::size_t kMaxPivots = 4;

  /// Starts without pivots: the pdf is that of `flight`. `flight` MUST outlive this object, and its
  /// `scatter_probability()` MUST NOT be 0. `medium` is the medium of the segment.
  LightDistanceSampler(const FreeFlight& flight, const Medium& medium)
      : flight_(flight), extinction_(mean_extinction(medium)) {}

  /// Adds equiangular sampling towards `pivot`, a point on a light. The segment starts at `origin`,
  /// and has the unit direction `direction` and the length `length`. All pivots have the same total
  /// weight in the mixture. Within the weight of a pivot, the share of free-flight sampling is
  /// between 1/16 and 1/2 and grows with the optical depth up to the pivot.
  void add(const Vec3& origin, const Vec3& direction, double length, const Vec3& pivot) {
    if (pivots_ == kMaxPivots) {
      return;
    }
    angles_[size_] = Equiangular(origin, direction, length, pivot);
    // The integrand is the light scattered towards the start of the segment, per distance. If the
    // medium absorbs and scatters little up to the pivot, the integrand is nearly proportional to
    // the pdf of equiangular sampling. If the pivot lies behind many mean free paths, most of the
    // light is scattered near the start, and free-flight sampling is the better strategy.
    const double depth = extinction_ * bandsaw::length(pivot - origin);
    const double free_flight = std::clamp(0.5 - 0.5 / (1 + depth), kMinFreeFlightShare, 0.5);
    share_[size_++] = 1 - free_flight;
    free_flight_share_ += free_flight;
    ++pivots_;
  }
  /// Adds a light without a position (distant or environment). Its irradiance does not vary along
  /// the segment, so its share of the mixture is free-flight sampling.
  void add_distant() {
    if (pivots_ < kMaxPivots) {
      free_flight_share_ += 1;
      ++pivots_;
    }
  }

  /// Returns a distance in [0, length]. `choice` selects the strategy, `u` the distance; both in
  /// [0, 1).
  double sample(double choice, double u) const {
    double left = choice * static_cast<double>(std::max<std::size_t>(pivots_, 1));
    for (std::size_t i = 0; i < size_; ++i) {
      if (left < share_[i]) {
        return angles_[i].sample(u);
      }
      left -= share_[i];
    }
    const double free_flight = pivots_ == 0 ? 1 : free_flight_share_;
    return flight_.sample(std::min(left / free_flight, 1 - 0x1p-53), u);
  }
  /// Returns the pdf of `sample()` with respect to length.
  double pdf(double distance) const {
    if (size_ == 0) {
      return flight_.pdf(distance);
    }
    double sum = free_flight_share_ * flight_.pdf(distance);
    for (std::size_t i = 0; i < size_; ++i) {
      sum += share_[i] * angles_[i].pdf(distance);
    }
    return sum / static_cast<double>(pivots_);
  }

 private:
  /// Minimum share of free-flight sampling within the weight of a pivot.
  static constexpr double kMinFreeFlightShare = 0.0625;

  const FreeFlight& flight_;
  double extinction_;
  std::array<Equiangular, kMaxPivots> angles_;
  std::array<double, kMaxPivots> share_{};
  std::size_t size_ = 0;    ///< number of entries in `angles_` and `share_`
  std::size_t pivots_ = 0;  ///< number of pivots, including distant lights
  double free_flight_share_ =
      0;  ///< weight of free-flight sampling; with `share_` it sums to `pivots_`
};

}  // namespace bandsaw
