#pragma once

// Bounds of instances: a box for one at rest, a box with linearly moving sides for one that moves
// during the shutter interval.

#include <optional>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/interval.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns bounds, in world space, of `box`, which is in an instance's own space. They are enlarged
/// by `trips` times the rounding error of a ray that is transformed to that space and back.
/// `to_object` is the inverse of `to_world`.
Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object,
                  double trips = 1);

/// Bounds of something that moves: at the share u of the interval, it lies within the box (1 - u)
/// at_open + u at_close.
struct MovingBox {
  Box at_open;
  Box at_close;
};

/// Returns the bounds in the world, during Geometry::shutter, of `box`, which is in the instance's
/// own space. They are enlarged for the rounding error of rays that are transformed to that space
/// and back. The instance MUST have a frame. Returns std::nullopt if its placement is singular at
/// one of the times that are examined.
std::optional<MovingBox> moving_bounds(const Geometry& geometry, const Instance& instance,
                                       const Box& box);

}  // namespace bandsaw
