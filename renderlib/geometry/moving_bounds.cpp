// Bounds of instances. For a moving instance, the box is sampled at times between which the motion
// deviates little from a straight line. Each sampled box is enlarged by a bound of that deviation.
// The result is a box with linearly moving sides that contains all enlarged boxes.

#include "renderlib/geometry/moving_bounds.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "renderlib/geometry/placement.h"
#include "renderlib/math/constants.h"

namespace bandsaw {
namespace {

/// Wanted maximum deviation of a corner's path from a chord, relative to the size of the box. The
/// interval between two keys is cut into the number of pieces that keeps this maximum, but at most
/// kMaxPieces pieces. The bounds are correct for any values of the two constants.
constexpr double kWantedDeviation = 0x1p-6;
constexpr double kMaxPieces = 64;
/// Factor on the rounding margin of placed_bounds(). Rounding errors may be larger between the
/// sampled times than at the sampled times.
constexpr double kRoundingFactor = 8;

/// Upper bounds for a moving point: for its distance from the origin, its speed, and the length of
/// the second derivative of its position with respect to time.
struct Course {
  double distance = 0;
  double speed = 0;  ///< first derivative
  double bend = 0;   ///< second derivative
};

/// Returns the Frobenius norm of the linear part.
double norm(const Transform& t) {
  double sum = 0;
  for (const auto& row : t.m) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum += row[k] * row[k];
    }
  }
  return std::sqrt(sum);
}

/// Returns the length of the translation.
double translation_length(const Transform& t) {
  return length(Vec3{t.m[0][3], t.m[1][3], t.m[2][3]});
}

/// Returns the bounds for a point after a placement that does not change with time. `c` holds the
/// bounds for the point before the placement.
Course through(const Transform& placement, const Course& c) {
  const double n = norm(placement);
  return {n * c.distance + translation_length(placement), n * c.speed, n * c.bend};
}

/// Returns the bounds for a point q after the motion T + R S q between two keys. `c` holds the
/// bounds for q. S and T change linearly, and the rotation R has the angular speed w. With p = S q,
/// |(R p)''| <= w^2 |p| + 2 w |p'| + |p''|.
Course through(const Key& a, const Key& b, const Course& c) {
  const double duration = b.time - a.time;
  const double scale = std::max(max_abs(a.pose.scale), max_abs(b.pose.scale));
  const double growth = max_abs(b.pose.scale - a.pose.scale) / duration;
  const double turning = 2 * kPi * turn_between(a.pose.rotate, b.pose.rotate) / duration;
  const Course p = {scale * c.distance, growth * c.distance + scale * c.speed,
                    2 * growth * c.speed + scale * c.bend};
  const double speed = length(b.pose.translate - a.pose.translate) / duration;
  const double far = std::max(length(a.pose.translate), length(b.pose.translate));
  return {far + p.distance, speed + turning * p.distance + p.speed,
          turning * turning * p.distance + 2 * turning * p.speed + p.bend};
}

/// Returns the bounds for a point after the motion and the placement of a frame. `c` holds the
/// bounds for the point before both. The result holds for an interval that contains `time` and no
/// key of the frame in its interior.
Course through(const Frame& frame, double time, const Course& c) {
  const auto after = std::upper_bound(frame.keys.begin(), frame.keys.end(), time,
                                      [](double t, const Key& key) { return t < key.time; });
  const bool rests = after == frame.keys.begin() || after == frame.keys.end();
  const Course within =
      rests ? through(motion_at(frame, time), c) : through(*(after - 1), *after, c);
  return through(frame.placement, within);
}

/// Returns upper bounds, in world space, of distance, speed and bend for every point of `box`. The
/// box is in the instance's own space. The result holds for an interval that contains `time` and no
/// key in its interior.
Course course_of(const Geometry& geometry, const Instance& instance, const Box& box, double time) {
  const Vec3 far = {std::max(std::abs(box.lo.x), std::abs(box.hi.x)),
                    std::max(std::abs(box.lo.y), std::abs(box.hi.y)),
                    std::max(std::abs(box.lo.z), std::abs(box.hi.z))};
  Course course = through(instance.to_world, {length(far), 0, 0});
  for (FrameId id = instance.frame; id != kNoFrame; id = geometry.frames[index_of(id)].parent) {
    course = through(geometry.frames[index_of(id)], time, course);
  }
  return course;
}

/// Returns the times of the interval's ends and of the keys between them, in ascending order.
std::vector<double> times_of_keys(const Geometry& geometry, const Instance& instance,
                                  const Interval& interval) {
  std::vector<double> times = {interval.open, interval.close};
  for (FrameId id = instance.frame; id != kNoFrame; id = geometry.frames[index_of(id)].parent) {
    for (const Key& key : geometry.frames[index_of(id)].keys) {
      if (key.time > interval.open && key.time < interval.close) {
        times.push_back(key.time);
      }
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// Collects the boxes of an instance at sampled times. Each box is enlarged by a margin.
class SampledBoxes {
 public:
  SampledBoxes(const Geometry& geometry, const Instance& instance, const Box& box)
      : geometry_(geometry), instance_(instance), box_(box) {}

  /// Adds the box at `time`, enlarged by `margin` in world space. Returns false if the placement is
  /// singular.
  bool add(double time, double margin) {
    const Transform to_world = to_world_at(geometry_, instance_, time);
    const std::optional<Transform> to_object = inverse(to_world);
    if (!to_object) {
      return false;
    }
    Box there = placed_bounds(box_, to_world, *to_object, kRoundingFactor);
    const Vec3 around = {margin, margin, margin};
    there = {there.lo - around, there.hi + around};
    times_.push_back(time);
    boxes_.push_back(there);
    return true;
  }

  /// Returns the first and the last box, enlarged so that their linear interpolation contains every
  /// sampled box. Between two samples the motion deviates from the chord by at most the `margin` of
  /// the two boxes, so the result bounds the whole motion.
  MovingBox around(const Interval& interval) const {
    MovingBox result = {boxes_.front(), boxes_.back()};
    Vec3 below;
    Vec3 above;
    const double duration = interval.close - interval.open;
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const double u = duration > 0 ? (times_[i] - interval.open) / duration : 0;
      const Vec3 lo = lerp(result.at_open.lo, result.at_close.lo, u) - boxes_[i].lo;
      const Vec3 hi = boxes_[i].hi - lerp(result.at_open.hi, result.at_close.hi, u);
      below = {std::max(below.x, lo.x), std::max(below.y, lo.y), std::max(below.z, lo.z)};
      above = {std::max(above.x, hi.x), std::max(above.y, hi.y), std::max(above.z, hi.z)};
    }
    for (Box* end : {&result.at_open, &result.at_close}) {
      *end = {end->lo - below, end->hi + above};
    }
    return result;
  }

 private:
  const Geometry& geometry_;
  const Instance& instance_;
  const Box& box_;
  std::vector<double> times_;
  std::vector<Box> boxes_;
};

}  // namespace

Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object,
                  double rounding_factor) {
  double grown = 0;
  double shrunk = 0;
  double moved = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      grown = std::max(grown, std::abs(to_world.m[i][j]));
      shrunk = std::max(shrunk, std::abs(to_object.m[i][j]));
    }
    moved = std::max(moved, std::abs(to_world.m[i][3]));
  }
  const double largest = std::max(max_abs(box.lo), max_abs(box.hi));
  // The rounding error grows with the condition number (grown * shrunk) and with the largest number
  // in the transforms (the last factor). 2^-46 is 128 units of rounding (2^-53).
  const double slack = rounding_factor * 0x1p-46 * (grown * shrunk) * (3 * grown * largest + moved);
  const Vec3 margin = {slack, slack, slack};
  Box result;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = to_world.point({(corner & 1) != 0 ? box.hi.x : box.lo.x,
                                   (corner & 2) != 0 ? box.hi.y : box.lo.y,
                                   (corner & 4) != 0 ? box.hi.z : box.lo.z});
    result.add(p - margin);
    result.add(p + margin);
  }
  return result;
}

std::optional<MovingBox> moving_bounds(const Geometry& geometry, const Instance& instance,
                                       const Box& box) {
  const Interval& interval = geometry.shutter;
  const std::vector<double> times = times_of_keys(geometry, instance, interval);
  const double size = length(box.hi - box.lo);
  SampledBoxes sampled(geometry, instance, box);
  if (!sampled.add(times.front(), 0)) {
    return std::nullopt;
  }
  for (std::size_t i = 0; i + 1 < times.size(); ++i) {
    const double duration = times[i + 1] - times[i];
    const Course course = course_of(geometry, instance, box, times[i] + duration / 2);
    // A path with second derivative c deviates from its chord over h by at most c h^2 / 8.
    const double deviation = course.bend * duration * duration / 8;
    const double wanted = std::ceil(std::sqrt(deviation / (kWantedDeviation * size)));
    const double pieces = wanted >= 1 && wanted <= kMaxPieces ? wanted
                          : deviation > 0                     ? kMaxPieces
                                                              : 1;
    const double margin = deviation / (pieces * pieces) * (1 + 0x1p-20);
    for (double k = 0; k <= pieces; ++k) {
      const double time = k == pieces ? times[i + 1] : times[i] + duration * (k / pieces);
      if (!sampled.add(time, margin)) {
        return std::nullopt;
      }
    }
  }
  return sampled.around(interval);
}

}  // namespace bandsaw
