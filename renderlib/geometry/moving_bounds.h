#pragma once

// Where an instance is: one that rests as a box, one that moves as a box whose sides move linearly
// during the time that an image takes.

#include <optional>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// The world box of a placed box, with room for `trips` times the rounding of a ray that goes there
/// and back.
Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object,
                  double trips = 1);

/// From open to close, both included.
struct Interval {
  double open = 0;
  double close = 0;
  friend bool operator==(const Interval&, const Interval&) = default;
};

/// At any time u of the way through the interval all is within (1 - u) at_open + u at_close.
struct MovingBox {
  Box at_open;
  Box at_close;
};

/// Of `box`, a box in the instance's own space, with room for the rounding of rays that go there
/// and back. The instance has a frame. Nothing where a placement on the way is singular.
std::optional<MovingBox> moving_bounds(const Geometry& geometry, const Instance& instance,
                                       const Box& box, const Interval& interval);

}  // namespace bandsaw
