#pragma once

// Finds the regions of a medium along a ray, one after the other (Amanatides and Woo 1987, "A Fast
// Voxel Traversal Algorithm for Ray Tracing"). A region is a part of space with bounds of the
// density (grid_medium.h). The regions are the cubes of a block, and the space around the block.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "renderlib/math/constants.h"
#include "renderlib/math/vec.h"
#include "renderlib/medium/grid_medium.h"

namespace bandsaw {

/// A ray in the space of a medium. Its parameter is the distance in the world; `direction` has any
/// length.
struct GridRay {
  Vec3 origin;
  Vec3 direction;

  Vec3 at(double distance) const { return origin + direction * distance; }
};

/// The part of a ray in one region, from distance `begin` to `end`.
struct RegionSpan {
  double begin = 0;
  double end = 0;
  Region region;
};

/// Iterates over the spans of a ray from distance 0 to `length`. The spans follow each other
/// without a gap.
class RegionWalk {
 public:
  /// `regions` MUST outlive this object. `length` >= 0, may be infinite.
  RegionWalk(const Regions& regions, const GridRay& ray, double length)
      : regions_(regions), length_(length) {
    const Vec3 from = regions.from_medium.point(ray.origin);
    const Vec3 along = regions.from_medium.direction(ray.direction);
    speed_ = bandsaw::length(along);
    origin_ = {from.x, from.y, from.z};
    direction_ = {along.x, along.y, along.z};
    low_ = {regions.low.x, regions.low.y, regions.low.z};
    const std::array<double, 3> high = {regions.high.x, regions.high.y, regions.high.z};
    enter_ = 0;
    leave_ = regions.regions.empty() ? 0 : length;
    for (std::size_t k = 0; k < 3; ++k) {
      if (direction_[k] != 0) {
        const double a = (low_[k] - origin_[k]) / direction_[k];
        const double b = (high[k] - origin_[k]) / direction_[k];
        enter_ = std::max(enter_, std::min(a, b));
        leave_ = std::min(leave_, std::max(a, b));
      } else if (!(origin_[k] >= low_[k] && origin_[k] <= high[k])) {
        leave_ = 0;
      }
    }
    if (enter_ < leave_) {
      begin_block();
    } else {
      enter_ = leave_ = length;  // the ray misses the block
    }
  }

  /// Returns the length of the ray's direction in the space of the regions.
  double speed() const { return speed_; }

  /// Sets the next span; returns false at the end.
  bool next(RegionSpan& span) {
    if (!(at_ < length_)) {
      return false;
    }
    span.begin = at_;
    if (at_ < enter_ || at_ >= leave_) {
      at_ = at_ < enter_ ? std::min(enter_, length_) : length_;
      span.region = regions_.around;
    } else {
      span.region =
          regions_
              .regions[(std::size_t{cube_[2]} * regions_.count[1] + cube_[1]) * regions_.count[0] +
                       cube_[0]];
      step();
    }
    span.end = at_;
    return true;
  }

 private:
  /// Finds the cube in which the ray enters the block.
  void begin_block() {
    for (std::size_t k = 0; k < 3; ++k) {
      const double inside = (origin_[k] + direction_[k] * enter_ - low_[k]) / regions_.side;
      const double last = regions_.count[k] - 1;
      cube_[k] = static_cast<std::uint32_t>(std::min(std::max(inside, 0.0), last));
      next_[k] = plane(k);
    }
  }
  /// Returns the distance at which the ray leaves the current cube along axis k.
  double plane(std::size_t k) const {
    if (direction_[k] == 0) {
      return kInfinity;
    }
    const double to = low_[k] + regions_.side * (cube_[k] + (direction_[k] > 0 ? 1.0 : 0.0));
    return (to - origin_[k]) / direction_[k];
  }
  /// Goes to the end of the current cube, and makes the next one the current cube.
  void step() {
    const std::size_t k =
        next_[0] < next_[1] ? (next_[0] < next_[2] ? 0 : 2) : (next_[1] < next_[2] ? 1 : 2);
    // Rounding may place a plane before the point that was reached.
    at_ = std::max(at_, std::min(next_[k], leave_));
    const bool at_face = direction_[k] > 0 ? cube_[k] + 1 == regions_.count[k] : cube_[k] == 0;
    if (at_face) {
      at_ = leave_;
      return;
    }
    cube_[k] += direction_[k] > 0 ? 1u : ~0u;
    next_[k] = plane(k);
  }

  const Regions& regions_;
  double length_;
  double speed_ = 0;
  std::array<double, 3> origin_{};
  std::array<double, 3> direction_{};
  std::array<double, 3> low_{};
  double enter_ = 0;                     ///< distance at which the ray enters the block of cubes
  double leave_ = 0;                     ///< distance at which the ray leaves the block
  double at_ = 0;                        ///< distance at which the next span begins
  std::array<std::uint32_t, 3> cube_{};  ///< the current cube
  std::array<double, 3> next_{};         ///< distance at which the ray leaves the cube, by axis
};

}  // namespace bandsaw
