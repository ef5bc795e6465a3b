#pragma once

// Bounds of instances. An instance at rest has a box. An instance that moves during the shutter
// interval has a box with linearly moving sides.

#include <optional>

#include "renderlib/geometry/box.h"
#include "renderlib/geometry/interval.h"
#include "renderlib/geometry/shapes.h"

namespace bandsaw {

/// Returns the bounds of `box` in world space. `box` is in an instance's own space, and `to_object`
/// is the inverse of `to_world`. The bounds are enlarged by `rounding_factor` times the rounding
/// error of a ray that is transformed to the instance's space and back.
Box placed_bounds(const Box& box, const Transform& to_world, const Transform& to_object,
                  double rounding_factor = 1);

/// Bounds of something that moves: at the share u of the interval, it lies within the box (1 - u)
/// at_open + u at_close.
struct MovingBox {
  Box at_open;
  Box at_close;
};

/// Returns the bounds of `box` in world space during Geometry::shutter. `box` is in the instance's
/// own space. The bounds are enlarged for the rounding error of rays that are transformed to the
/// instance's space and back. The instance MUST have a frame. Returns std::nullopt if its placement
/// is singular at one of the times that are examined.
std::optional<MovingBox> moving_bounds(const Geometry& geometry, const Instance& instance,
                                       const Box& box);

}  // namespace bandsaw
